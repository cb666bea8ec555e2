#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# instruction_sets.sh TELEOP: a run has the same bits with each instruction set that the processor
# has; one that it has not is refused at the start, with those that it has.
set -eu
teleop=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"

if REPEL_ISA=z80 "$teleop" --fast --seconds 0.1 >said 2>&1; then
  echo "REPEL_ISA=z80 was not refused"
  exit 1
fi
grep "REPEL_ISA is 'z80'; this processor and this library have: " said || {
  cat said
  exit 1
}
sets=$(sed -n "s/.*this library have: //p" said | tr -d ,)
for scene in anderson_4x8 plates two_arms; do
  for set in $sets; do
    REPEL_ISA=$set "$teleop" "$scene" --fast --seconds 1 --quiet --log "$set.csv" \
      --report "$set.json"
    grep -q "\"instruction_set\": *\"$set\"" "$set.json" || {
      echo "the report does not name $set"
      exit 1
    }
    cmp "$set.csv" "${sets%% *}.csv"
  done
  echo "$scene: the same bits with $sets"
done
