#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# check.sh BUILD: installs the finished build folder BUILD into a scratch folder, moves what it
# installed, and uses the library in every way a stranger would.
set -eu
here=$(dirname "$(readlink -f "$0")")
root=$(readlink -f "$here/../..")
build=$(readlink -f "$1")
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
strict="-std=c++20 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Werror"

# Runs a step; what it said is shown only if it fails.
step() {
  title=$1
  shift
  if "$@" >"$scratch/log" 2>&1; then
    echo "ok      $title"
  else
    echo "FAILED  $title"
    cat "$scratch/log"
    exit 1
  fi
}

# configure CONSUMER CMAKE-ARGS...
configure() {
  source=$here/$1
  shift
  rm -rf "$scratch/build"
  cmake -S "$source" -B "$scratch/build" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" "$@"
}

# works CONSUMER CMAKE-ARGS...: configures, builds and runs.
works() {
  configure "$@" && cmake --build "$scratch/build" --target consumer && "$scratch/build/consumer"
}

# fails_saying TEXT CONSUMER CMAKE-ARGS...: configuring fails, and the message holds TEXT.
fails_saying() {
  text=$1
  shift
  ! configure "$@" >"$scratch/said" 2>&1 || return 1
  tr -s ' \n' ' ' <"$scratch/said" | tee "$scratch/flat"
  grep -qF "$text" "$scratch/flat"
}

# A program that is compiled for other registers than the parts it links must not link, and the
# linker must say it of each part.
fails_to_link_for_other_registers() {
  configure find_package "-DPARTS=$parts" -DCMAKE_CXX_FLAGS="$1" || return 1
  ! cmake --build "$scratch/build" --target consumer >"$scratch/said" 2>&1 || return 1
  for part in $(echo "$parts" | tr ';' ' '); do
    # In the others there is nothing to tell by, or it is told by what they include.
    case $part in
      control | simulated | robots | cover | percepts | octrees | scene | visual) ;;
      *) continue ;;
    esac
    grep "repel::$part::is_built_for(repel::EigenAlignment<.*VectorRegister<" "$scratch/said" ||
      return 1
  done
}

# An older language is refused in one line, not in hundreds.
says_once_that_the_language_is_too_old() {
  echo '#include <repel/repel.hpp>' >"$scratch/old.cpp"
  ! "$1" -std=c++17 -fsyntax-only -I "$root/core" -isystem /usr/include/eigen3 "$scratch/old.cpp" \
    >"$scratch/said" 2>&1 || return 1
  grep 'error' "$scratch/said" | tee "$scratch/errors"
  [ "$(grep -c 'error:' "$scratch/errors")" = 1 ] && grep -q 'needs C++20' "$scratch/errors"
}

# plain COMPILER FLAGS...: no build system at all.
plain() {
  "$@" -o "$scratch/plain" && "$scratch/plain"
}

install_and_move() {
  cmake --install "$build" --prefix "$scratch/first" >"$scratch/installed" &&
    mv "$scratch/first" "$scratch/moved"
  cat "$scratch/installed"
  ! grep 'not built' "$scratch/installed"
}

step "configure without each part, and with each alone" \
  sh "$here/switches.sh" "$root" "$scratch/switched"

# A build of some targets only, as that of ./run, is installed as far as it goes.
install_a_part() {
  cmake -S "$root" -B "$scratch/half" -G Ninja -DCMAKE_UNITY_BUILD=ON -DREPEL_BUILD_TESTS=OFF \
    -DREPEL_BUILD_BENCH=OFF &&
    cmake --build "$scratch/half" --target repel_record &&
    cmake --install "$scratch/half" --prefix "$scratch/of_half" >"$scratch/installed" || return 1
  [ ! -e "$root/apps/qualify" ] || grep 'qualify is not built' "$scratch/installed"
}
step "install a build of one library" install_a_part
prefix=$scratch/of_half
step "find_package, what was built of it" works find_package "-DPARTS=core;record"
if [ -e "$(find "$build" -name 'librepel_robots.*')" ]; then
  step "find_package, what was not" \
    fails_saying "without its part 'robots'" find_package -DPARTS=robots
fi

prefix=$scratch/moved
step "install, then move" install_and_move
package=$(dirname "$(find "$prefix" -name repel-config.cmake)")

parts=
all_parts=$(sed -n 's/^set(repel_packages_\([a-z]*\) .*/\1/p' "$package/repel-config.cmake")
for part in $all_parts; do
  [ ! -e "$package/repel-$part.cmake" ] || parts="${parts:+$parts;}$part"
done

step "find_package, core only, nothing else installed" works find_package -DPARTS=core \
  -DCMAKE_DISABLE_FIND_PACKAGE_orocos_kdl=ON -DCMAKE_DISABLE_FIND_PACKAGE_urdfdom=ON \
  -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON
step "find_package, $parts" works find_package "-DPARTS=$parts"
if echo 'int i;' | ${CXX:-c++} -mavx512f -mfma -x c++ -c - -o "$scratch/plain" 2>/dev/null; then
  step "a program for other registers than its parts" \
    fails_to_link_for_other_registers "-mavx512f -mfma"
fi
step "find_package, a part that does not exist" \
  fails_saying "repel has no part 'cellar'" find_package -DPARTS=cellar
case $parts in *scene*)
  step "find_package, a part whose packages are gone" \
    fails_saying "apt-get install libyaml-dev" find_package -DPARTS=scene \
    -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON ;;
esac
rm -f "$package/repel-bullet.cmake"
step "find_package, a part that was not built" \
  fails_saying "without its part 'bullet': apt-get install libbullet-dev" \
  find_package -DPARTS=bullet
step "add_subdirectory" works add_subdirectory "-DREPEL=$root"

install_the_parent() {
  configure parent "-DREPEL=$root" && cmake --build "$scratch/build" &&
    cmake --install "$scratch/build" --prefix "$scratch/of_parent" &&
    rm -r "$scratch/build"
}
step "add_subdirectory in a project that exports a library" install_the_parent
prefix=$scratch/of_parent
step "a program that links that library" works of_parent
prefix=$scratch/moved

[ ! -e "$prefix/bin/teleop" ] ||
  step "the installed program" "$prefix/bin/teleop" --seconds 0.1 --fast

# completes WANTED WORDS...: what bash offers for the last word.
completes() {
  # shellcheck disable=SC2016  # the dollars are the inner shell's
  bash -c '
    . "$1/share/bash-completion/completions/teleop"
    wanted=$2 program=$1/bin/teleop
    shift 2
    COMP_WORDS=("$program" "$@") COMP_CWORD=$# COMPREPLY=()
    _repel
    echo "${COMPREPLY[*]}"
    [ "${COMPREPLY[*]}" = "$wanted" ]' completes "$prefix" "$@"
}
if [ -e "$prefix/bin/teleop" ]; then
  step "completion of an option" completes --backend --back
  step "completion of its words" completes ode --backend o
  step "completion of a scene" completes anderson_4x8 anderson
  step "completion of a command" completes replay repl
  step "completion of an option of a command" completes --impaired site --imp
  step "completion of a scene of a command" completes anderson_4x8 check anderson
fi

sources="$here/main.cpp $here/elsewhere.cpp"
PKG_CONFIG_PATH=$prefix/share/pkgconfig
export PKG_CONFIG_PATH
# shellcheck disable=SC2046,SC2086
step "pkg-config and g++" plain g++ -std=c++20 $sources $(pkg-config --cflags --libs repel)
# shellcheck disable=SC2046
step "pkg-config and g++, with the machine" g++ -std=c++20 "$root/examples/03_own_controller.cpp" \
  $(pkg-config --cflags --libs repel-control) -o "$scratch/plain"
step "g++ with the machine in one source" g++ -std=c++20 -I "$root/core" -I "$root/control" \
  -isystem /usr/include/eigen3 "$root/examples/03_own_controller.cpp" \
  "$root/control/repel/control.cpp" -o "$scratch/plain"
for compiler in g++ clang++; do
  command -v $compiler >/dev/null || continue
  # shellcheck disable=SC2086
  step "$compiler -I core, all warnings" \
    plain $compiler $strict $sources -I "$root/core" -isystem /usr/include/eigen3
  step "$compiler -std=c++17" says_once_that_the_language_is_too_old $compiler
done
