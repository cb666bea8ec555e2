#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# instructions.sh PROGRAM FILE [--renew]: counts the instructions of every tick of fixed_scenario
# under callgrind and fails if their median or the worst has grown by more than 3 % over FILE. With
# --renew they become the file's. Counts are those of one compiler: another one is not judged.
set -eu
LC_ALL=C
export LC_ALL
program=$1
file=$2
tolerance=3 # %

skip() {
  echo "skipped: $1"
  exit 77
}
command -v valgrind >/dev/null || skip "valgrind is missing; to have it: apt-get install valgrind"
# The C library chooses its functions by the processor: without fma they are others.
grep -qw fma /proc/cpuinfo || skip "this processor has no fma instruction"

profiles=$(mktemp -d)
trap 'rm -rf "$profiles"' EXIT
# One profile for each tick (tick.1, tick.2, ...), with its instructions in a line of its own.
if ! valgrind --tool=callgrind --instr-atstart=no --callgrind-out-file="$profiles/tick" \
  "$program" >"$profiles/log" 2>&1; then
  cat "$profiles/log"
  exit 1
fi
find "$profiles" -name 'tick.*' -exec sed -n 's/^summary: //p' {} + | sort -n >"$profiles/counts"
[ -s "$profiles/counts" ] || { echo "no profile of a tick"; cat "$profiles/log"; exit 1; }
ticks=$(wc -l <"$profiles/counts")
median=$(sed -n "$(((ticks + 1) / 2))p" "$profiles/counts")
worst=$(sed -n '$p' "$profiles/counts")
compiler=$("$program" --compiler)

if [ "${3:-}" = --renew ]; then
  {
    sed -n '/^#/p' "$file"
    printf 'compiler %s\nmedian %d\nworst %d\n' "$compiler" "$median" "$worst"
  } >"$profiles/new"
  cp "$profiles/new" "$file"
fi

# noted KEY: what the file says.
noted() {
  sed -n "s/^$1 //p" "$file"
}
# grown COUNT NOTED: more by too much?
grown() {
  [ $((100 * $1)) -gt $(((100 + tolerance) * $2)) ]
}

# A gate that lets everything through would pass as well.
{ grown 104 100 && ! grown 103 100; } || { echo "the gate is not at $tolerance %"; exit 1; }

echo "instructions in a tick ($compiler, $ticks ticks): median $median, worst $worst"
echo "in the file ($(noted compiler)): median $(noted median), worst $(noted worst)"
[ "$compiler" = "$(noted compiler)" ] || skip "the file is of another compiler"
renewal="to change the file on purpose: sh $0 $program $file --renew"
if grown "$median" "$(noted median)" || grown "$worst" "$(noted worst)"; then
  echo "more than $tolerance % more; $renewal"
  exit 1
fi
if grown "$(noted median)" "$median" || grown "$(noted worst)" "$worst"; then
  echo "fewer by enough that a step back would pass; $renewal"
fi
