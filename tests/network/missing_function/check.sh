#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# What the compiler says of a module that lacks a function, or has one that would never be called:
# one error for each, in words.
#   check.sh COMPILER INCLUDE_FLAGS...
compiler=$1
shift
here=$(dirname "$0")
status=0

# expect COUNT FILE WORDS...: exactly so many errors, which have all the words.
expect() {
  count=$1
  file=$2
  shift 2
  # shellcheck disable=SC2086  # several flags
  said=$("$compiler" -std=c++20 -fsyntax-only $flags "$here/$file" 2>&1)
  errors=$(printf '%s\n' "$said" | grep 'error:')
  if [ "$(printf '%s\n' "$errors" | grep -c .)" != "$count" ]; then
    printf '%s: not %s:\n%s\n' "$file" "$count" "$said"
    status=1
  fi
  for words in "$@"; do
    printf '%s\n' "$errors" | grep -qF "$words" && continue
    printf '%s: "%s" is missing in:\n%s\n' "$file" "$words" "$errors"
    status=1
  done
}

flags=$*
expect 1 one_way.cpp "repel: a two-port needs 'void incident("
expect 1 nothing.cpp "repel: a module needs 'bool reflected(" "(one-port)"
expect 1 deaf.cpp "repel: a matched one-port needs 'void incident("
expect 1 half_deaf.cpp "repel: 'incident' of a one-port must be"
expect 14 misnamed.cpp "'traits' of a module must be" \
  "'void fit(Space" "'int size() const" "'void face(Side" "'void suit(const RobotEnd&" \
  "'void prepare(double" "'void read(const Signals&" "'double supplied() const" \
  "'double left_weight() const" "'bool saturated() const" "'void add_walls(const Jacobian&" \
  "'void add_wall_damping(const" "'void predict(const Signals&" "'PassivityReport passivity() const"
exit $status
