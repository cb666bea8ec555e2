#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# Gives the force law one more term, in the one place that docs/architecture.md names, and sees
# every path follow. The law once stood in two places: a box got 140.6 N in its first tick and
# 56.3 N from then on.
#   check.sh COMPILER EIGEN_FOLDER CORE_FOLDER CONTROL_FOLDER
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
# The compiled rooms that evaluate pairs, without the rest of the machine.
set -- "$@" "$here/own_term.cpp" "$4"/repel/schedule/*.cpp
compiler=$1 eigen=$2 core=$3 control=$4
shift 4
cat >"$folder/all.cpp" <<END
$(printf '#include "%s"\n' "$@")
END
"$compiler" -std=c++20 -O1 -I "$folder" -I "$core" -I "$control" -isystem "$eigen" \
  "$folder/all.cpp" -pthread -o "$folder/own_term"
"$folder/own_term"
