# SPDX-License-Identifier: BSD-3-Clause
# Sourced by scripts, which set `root` to the folder of this repository.
# shellcheck shell=sh disable=SC2154

# The packages of the named parts, see debian-packages.txt.
packages_of() {
  for part in "$@"; do
    awk -v part="$part" '$1 == part { print $2 }' "$root/cmake/debian-packages.txt"
  done
}

# The parts that a script needs: those of its heading in debian-packages.txt and of all above it.
parts_for() {
  awk -v script="$1" '
    $1 == "for" { if (found) exit; found = $2 == script; next }
    /^[a-z]/ && !listed[$1]++ { parts = parts " " $1 }
    END { if (found) print parts }
  ' "$root/cmake/debian-packages.txt"
}

# Runs a command; says nothing but a progress line on a terminal, and everything if it fails.
quietly() {
  log=$(mktemp)
  if "$@" </dev/null 2>&1; then echo succeeded; fi | tee "$log" | show_progress
  if [ "$(tail -n 1 "$log")" != succeeded ]; then
    cat "$log" >&2
    rm -f "$log"
    return 1
  fi
  rm -f "$log"
}

show_progress() {
  [ -t 2 ] || exec cat >/dev/null
  while IFS= read -r line; do printf '\r\033[K%.78s' "$line" >&2; done
  printf '\r\033[K' >&2
}

apt_as_root() {
  if [ "$(id -u)" = 0 ]; then
    DEBIAN_FRONTEND=noninteractive apt-get "$@"
  else
    sudo env DEBIAN_FRONTEND=noninteractive apt-get "$@"
  fi
}

# Installs what the named parts need and this machine lacks.
install_packages() {
  command -v dpkg-query >/dev/null || return 0  # not Debian: CMake says what it does not find
  wanted=$(packages_of "$@" | awk '!seen[$0]++')
  # It fails where one of them is not known, which must not end a script that sets pipefail.
  # shellcheck disable=SC2016,SC2086
  present=" $({ dpkg-query -W -f '${Package} ${db:Status-Status}\n' $wanted 2>/dev/null || :; } |
    awk '$2 == "installed" { printf "%s ", $1 }')"
  missing=
  for package in $wanted; do
    case $present in *" $package "*) continue ;; esac
    ! is_known "$package" || missing="$missing $package"
  done
  [ -n "$missing" ] || return 0

  if [ "$(id -u)" != 0 ] && ! sudo -v 2>/dev/null; then  # asks for the password, if any
    ask_for_packages
  fi
  echo "Installing$missing" >&2
  quietly apt_as_root update -q || true  # one broken source need not matter
  known=
  for package in $missing; do
    if is_known "$package"; then known="$known $package"; else
      echo "This release has no $package; what needs it is left out." >&2
    fi
  done
  missing=$known
  # shellcheck disable=SC2086
  quietly apt_as_root install -qy --no-install-recommends $missing || ask_for_packages
  reconfigure=yes  # a part that was left out may be possible now
}

# Whether apt has heard of a package; of all of them, as long as it has no lists. A name it does not
# know it takes for a pattern, and g++ would be one that much matches: cmake is not.
is_known() {
  apt-cache show "$1" >/dev/null 2>&1 || ! apt-cache show cmake >/dev/null 2>&1
}

# install_packages_for SCRIPT [PARTS...]: what the script needs, and more parts.
install_packages_for() {
  script=$1
  shift
  # shellcheck disable=SC2046
  install_packages $(parts_for "$script") "$@"
}

ask_for_packages() {
  printf "Packages are missing. Run this as root, then start again:\n\n  %s\n" \
    "apt-get update && apt-get install -y --no-install-recommends$missing" >&2
  exit 1
}

# build PRESET [TARGET...]: configures when needed, then builds. Its first run takes minutes.
build() {
  tree=$root/build/$1
  if ! is_configured "$tree"; then
    echo "Building in build/$1; the first time takes a while." >&2
    (cd "$root" && quietly cmake --preset "$1") || exit 1
  fi
  shift
  quietly cmake --build "$tree" ${1:+--target "$@"} || exit 1
}

is_configured() {
  [ -z "${reconfigure:-}" ] &&
    [ -n "$(find "$1/build.ninja" -newer "$root/CMakePresets.json" 2>/dev/null)" ]
}
