#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Proves that the rules are alive: each tree in canaries/rules breaks the rule it is named after
# (up to a dot), the one named `none` breaks none, and every rule has a tree.
set -eu
here=$(dirname "$(readlink -f "$0")")
failed=0

fail() {
  echo "$1"
  failed=1
}

for tree in "$here"/canaries/rules/*; do
  name=$(basename "$tree")
  rule=${name%%.*}
  if said=$("$here/check.sh" "$tree"); then
    [ "$rule" = none ] || fail "$name: passed, should break [$rule]"
  elif [ "$(echo "$said" | grep -cF "[$rule]")" != "$(echo "$said" | wc -l)" ]; then
    fail "$name: should break [$rule] and nothing else, but: $said"
  fi
done

# The rules are the words in brackets in what check.sh prints and the first words of breach().
rules=$(sed -n 's/.*: \[\([a-z-]*\)\] .*/\1/p; s/.*breach("\([a-z-]*\)".*/\1/p' \
  "$here/check.sh" "$here/lines.awk" | sort -u)
for rule in $rules; do
  [ -d "$here/canaries/rules/$rule" ] || fail "the rule $rule has no canary"
done
exit "$failed"
