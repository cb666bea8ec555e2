#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# switches.sh ROOT SCRATCH: configures the project without each part that has a switch, and with
# each of them alone, in the folder SCRATCH. Suites and programs that link a part must be left out
# with it: else CMake does not find its target.
set -eu
root=$1
scratch=$2
mkdir -p "$scratch"

# configure FOLDER CMAKE-ARGS...
configure() {
  folder=$scratch/$1
  shift
  cmake -S "$root" -B "$folder" -G Ninja "$@" >"$folder.log" 2>&1 && return
  grep -A 4 'CMake Error' "$folder.log"
  echo "does not configure with: $*"
  return 1
}

configure all
sed -n 's/^\(REPEL_WITH_[A-Z]*\):BOOL=.*/\1/p' "$scratch/all/CMakeCache.txt" |
  grep -v '^REPEL_WITH_PARTS$' >"$scratch/switches"
[ "$(wc -l <"$scratch/switches")" -ge 14 ]

failed=0
while read -r switch; do
  configure "without_$switch" "-D$switch=OFF" || failed=1
  configure "only_$switch" -DREPEL_WITH_PARTS=OFF "-D$switch=ON" || failed=1
  rm -rf "$scratch/without_$switch" "$scratch/only_$switch"
done <"$scratch/switches"
exit $failed
