#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Proves that .clang-tidy is alive: every pattern in it names checks that exist, and every file in
# canaries/tidy is rejected by the check it names.
set -eu
here=$(dirname "$(readlink -f "$0")")
config=$here/../../.clang-tidy
failed=0

patterns=$(sed -n '/^Checks:/,/^WarningsAsErrors/s/^  -*\([a-z][^,]*\),*$/\1/p' "$config")
for pattern in $patterns; do
  [ "$pattern" != 'clang-diagnostic-*' ] || continue  # the compiler's warnings are never listed
  clang-tidy --checks="-*,$pattern" --list-checks 2>/dev/null | grep -q '^    ' ||
    { echo ".clang-tidy: $pattern names no check"; failed=1; }
done

for canary in "$here"/canaries/tidy/*.cpp; do
  check=$(sed -n 's|^// rejected by ||p' "$canary")
  if said=$(clang-tidy --quiet --config-file="$config" "$canary" -- -std=c++20 -Wall 2>/dev/null) ||
    ! echo "$said" | grep -qF "error: " || ! echo "$said" | grep -qF "[$check,"; then
    echo "$(basename "$canary"): should be rejected by $check, but: $said"
    failed=1
  fi
done
exit "$failed"
