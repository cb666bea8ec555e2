#!/bin/sh
# SPDX-License-Identifier: BSD-3-Clause
# check.sh [ROOT]: keeps the rules of the house in every file below ROOT. Prints one line for each
# breach, as file:line: [its rule] and what is wrong, and fails if there is one.
set -eu
here=$(dirname "$(readlink -f "$0")")
cd "${1:-$here/../..}"
LC_ALL=C
export LC_ALL

# The files of the repository, without what is built and without what is meant to break a rule.
files() {
  find . \( -name .git -o -path ./build -o -path ./tests/style/canaries \) -prune -o \
    -type f -print | sort
}

breaches() {
  rooms=$(cat "$here/rooms.txt")
  runs=$(cat "$here/runs.txt")
  files | grep -E '\.(hpp|cpp|cmake|txt|sh|awk|md|yaml|urdf)$|/[^.]*$' | grep -v '/LICENSE$' |
    tr '\n' '\0' | xargs -0 awk -v rooms="$rooms" -v runs="$runs" -f "$here/lines.awk"
  headers_without_a_test
  headers_of_the_kernel_not_in_the_umbrella
  sources_not_in_the_one
  circles
  dead_links
}

# The headers in the rooms of kernel and machine, as FOLDER/repel/ROOM/NAME.
headers() {
  files | sed -n 's#^\./\(\(core\|control\)/repel/.*/.*\)\.hpp$#\1#p'
}

headers_without_a_test() {
  for header in $(headers); do
    test=tests/${header#*/repel/}_test.cpp
    [ -e "$test" ] || echo "$header.hpp:1: [test-beside] $test does not exist"
  done
}

headers_of_the_kernel_not_in_the_umbrella() {
  reached=$(included_from_the_umbrella)
  for header in $(headers | grep '^core/'); do
    echo "$reached" | grep -qxF "${header#core/}.hpp" ||
      echo "$header.hpp:1: [umbrella] repel/repel.hpp does not lead to it"
  done
}

sources_not_in_the_one() {
  for source in $(files | sed -n 's#^\./control/\(repel/.*/.*\.cpp\)$#\1#p'); do
    grep -qxF "#include <$source>" control/repel/control.cpp ||
      echo "control/$source:1: [one-source] control/repel/control.cpp does not include it"
  done
}

# Every header of the kernel that repel/repel.hpp includes, directly or through others.
included_from_the_umbrella() {
  find core -name '*.hpp' -exec grep -H '^#include <repel/' {} + 2>/dev/null |
    sed 's#^core/\(.*\):.*<\(.*\)>.*#\1 \2#' | awk '
      { from[NR] = $1; to[NR] = $2 }
      END {
        reached["repel/repel.hpp"] = more = 1
        while (more) {
          more = 0
          for (i = 1; i <= NR; i++)
            if (reached[from[i]] && !reached[to[i]]) more = reached[to[i]] = 1
        }
        for (header in reached) if (reached[header]) print header
      }'
}

# Includes that lead back to where they stand, so that none of the units on the way stands alone. A
# unit is X.hpp with X.cpp; the header may stand in repel/PART. An include in quotes counts within
# its folder. What leads nowhere is taken away first: without a circle, nothing is left.
circles() {
  find core control robots backends runs apps bench -name '*.[hc]pp' \
    -exec grep -Hn '^#include' {} + 2>/dev/null | awk -F '[:<">]' '
      function unit(path) {
        while (sub("[^/]+/[.][.]/", "", path)) {}
        if (!sub("^.*/repel/", "", path)) sub("^backends/", "", path)
        sub("[.][hc]pp$", "", path)
        return path
      }
      function leads(a, b,   i) {
        if (a == b) return 1
        if (!seen[a]++) for (i in from) if (from[i] == a && leads(to[i], b)) return 1
        return 0
      }
      {
        folder = $1
        sub("[^/]*$", "", folder)
        line[NR] = $1 ":" $2
        to[NR] = unit(/</ ? "/" $4 : folder $4)
        if (unit($1) != to[NR]) from[NR] = unit($1)
      }
      END {
        do {
          split("", open)
          for (i in from) open[from[i]] = 1
          more = 0
          for (i in from) if (!open[to[i]]) { delete from[i]; more = 1 }
        } while (more)
        for (i in from) {
          split("", seen)
          if (leads(to[i], from[i])) print line[i] ": [circle] " to[i] " leads back to " from[i]
        }
      }' | sort
}

# The targets of the links of a Markdown page, but for those of code.
links_of() {
  # shellcheck disable=SC2016  # the backquotes are those of Markdown
  sed '/^```/,/^```/d' "$1" | grep -o '](\([^) #]*\)' | sed 's/^](//'
}

# Links of Markdown pages to files of this repository.
dead_links() {
  for page in $(files | grep '\.md$'); do
    for link in $(links_of "$page" | grep -v ':' || true); do
      [ -e "$(dirname "$page")/$link" ] ||
        echo "$page:1: [dead-link] $link does not exist"
    done
  done
}

found=$(breaches)
[ -z "$found" ] || echo "$found"
[ -z "$found" ]
