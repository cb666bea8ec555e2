#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# debian_packages.sh ROOT BUILD: every library that the build folder BUILD links by the name of its
# file must come with a package of cmake/debian-packages.txt. What a machine happens to have besides
# hides that one is missing: assimp names zlib, and its package does not ask for zlib1g-dev.
set -eu
root=$1
. "$root/cmake/setup.sh"
if ! command -v dpkg-query >/dev/null; then
  echo "skipped: no dpkg-query, so this is not Debian"
  exit 77
fi

# packages_with PACKAGES: these and all that they depend on, of what is installed.
packages_with() {
  dpkg-query -W -f '${Package}|${Pre-Depends}, ${Depends}\n' |
    awk -F '|' -v wanted="$1" '
      { name = $1; sub(/^[^|]*\|/, ""); gsub(/\([^)]*\)|:[a-z0-9]+/, ""); gsub(/[,|]/, " ")
        needs[name] = needs[name] " " $0 }
      function take(name,   parts, n, i) {
        if (name in taken) return
        taken[name]
        print name
        n = split(needs[name], parts, " ")
        for (i = 1; i <= n; ++i) take(parts[i])
      }
      END { n = split(wanted, names, " "); for (i = 1; i <= n; ++i) take(names[i]) }'
}

# owners FILES...: "PACKAGE FILE"; Debian knows some files by the path without /usr.
owners() {
  for file in "$@"; do
    package=$( (dpkg-query -S "$file" || dpkg-query -S "${file#/usr}") 2>/dev/null |
      sed 's/[:,].*//; q')
    [ -z "$package" ] || echo "$package $file"
  done
}

# missing LISTED FILES...: which of FILES the packages LISTED and their dependencies do not bring.
missing() {
  packages_with "$1" >"$scratch"
  shift
  owners "$@" | awk 'NR == FNR { brought[$1]; next } !($1 in brought)' "$scratch" -
}

scratch=$(mktemp)
trap 'rm -f "$scratch"' EXIT
# shellcheck disable=SC2046
listed=$(packages_of $(parts_for test) | tr '\n' ' ')
files=$(grep -ohE '/usr/lib/[^ |:$]*\.(so[.0-9]*|a)( |$)' "$2/build.ninja" |
  grep -v libclang_rt | sort -u)
# shellcheck disable=SC2086
found=$(missing "$listed" $files)
if [ -n "$found" ]; then
  echo "linked, but in no package of cmake/debian-packages.txt, nor asked for by one:"
  echo "$found"
  exit 1
fi
# Its canary: one that no other package asks for must be missed.
yaml=$(printf '%s\n' "$files" | grep '/libyaml\.so$' || true)
without=$(echo "$listed" | sed 's/libyaml-dev//')
# shellcheck disable=SC2086
if [ -n "$yaml" ] && [ -z "$(missing "$without" $yaml)" ]; then
  echo "the canary was not refused: libyaml-dev left out"
  exit 1
fi
echo "$(echo "$files" | wc -l) libraries, all from packages asked for"
