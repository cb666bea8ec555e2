#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# What the compiler says of a module that lacks a function: one error, in words.
#   check.sh COMPILER INCLUDE_FLAGS...
compiler=$1
shift
here=$(dirname "$0")
status=0

# expect FILE WORDS...: exactly one error, which has all the words.
expect() {
  file=$1
  shift 1
  # shellcheck disable=SC2086  # several flags
  said=$("$compiler" -std=c++20 -fsyntax-only $flags "$here/$file" 2>&1)
  errors=$(printf '%s\n' "$said" | grep 'error:')
  if [ "$(printf '%s\n' "$errors" | grep -c .)" != 1 ]; then
    printf '%s: not one error:\n%s\n' "$file" "$said"
    status=1
  fi
  for words in "$@"; do
    printf '%s\n' "$errors" | grep -qF "$words" && continue
    printf '%s: "%s" is missing in:\n%s\n' "$file" "$words" "$errors"
    status=1
  done
}

flags=$*
expect one_way.cpp "repel: a two-port needs 'void incident("
expect nothing.cpp "repel: a module needs 'bool reflected(" "(one-port)"
expect deaf.cpp "repel: a matched one-port needs 'void incident("
exit $status
