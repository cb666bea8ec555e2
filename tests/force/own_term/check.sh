#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Gives the force law one more term, in the one place that docs/architecture.md names, and sees
# every path follow. The law once stood in two places: a box got 140.6 N in its first tick and
# 56.3 N from then on.
#   check.sh COMPILER EIGEN_FOLDER CORE_FOLDER
set -e
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
mkdir -p "$folder/repel/force"
sed 's/bent = surface_force \* inward \* inward/& * (1.0 + 8.0 * inward)/' \
  "$3/repel/force/law.hpp" >"$folder/repel/force/law.hpp"
if cmp -s "$3/repel/force/law.hpp" "$folder/repel/force/law.hpp"; then
  echo "law.hpp has no line to which the term can be added"
  exit 1
fi
"$1" -std=c++20 -O1 -I "$folder" -I "$3" -isystem "$2" "$here/own_term.cpp" -pthread \
  -o "$folder/own_term"
"$folder/own_term"
