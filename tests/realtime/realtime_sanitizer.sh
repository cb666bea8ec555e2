#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# realtime_sanitizer.sh ROOT EIGEN: builds nonblocking_tick.cpp with RealtimeSanitizer and runs it,
# where there is clang 20 or newer. The program must end well, and its canary must not. What
# -Wfunction-effects cannot prove is shown and not judged: Eigen and the clock make no such promise.
set -eu

major() {
  echo __clang_major__ | "$1" -E -P -x c++ - 2>/dev/null | tail -n 1
}
compiler=
for candidate in clang++ clang++-29 clang++-28 clang++-27 clang++-26 clang++-25 clang++-24 \
  clang++-23 clang++-22 clang++-21 clang++-20; do
  command -v "$candidate" >/dev/null || continue
  if [ "$(major "$candidate")" -ge 20 ]; then
    compiler=$candidate
    break
  fi
done
if [ -z "$compiler" ]; then
  echo "skipped: no clang++ 20 or newer; to have it: apt-get install clang-22 libclang-rt-22-dev"
  exit 77
fi

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$compiler" -std=c++20 -O1 -g1 -ffp-contract=off -fsanitize=realtime -Wfunction-effects \
  -I "$1/core" -I "$1/control" -I "$1/tests" -isystem "$2" \
  "$1/tests/realtime/nonblocking_tick.cpp" "$1/control/repel/control.cpp" \
  -o "$folder/tick" -pthread 2>"$folder/warnings" || { cat "$folder/warnings"; exit 1; }
grep -q "must not call non-'nonblocking' function 'malloc'" "$folder/warnings" ||
  { echo "-Wfunction-effects does not see the canary"; exit 1; }
echo "$compiler, not proven by -Wfunction-effects:"
grep 'cannot be inferred' "$folder/warnings" || echo "  nothing"

"$folder/tick"
if "$folder/tick" --canary >"$folder/canary" 2>&1; then
  echo "the canary was not refused"
  exit 1
fi
grep -q malloc "$folder/canary" || { cat "$folder/canary"; exit 1; }
