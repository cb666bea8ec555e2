#!/bin/sh
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
  files | grep -E '\.(hpp|cpp|cmake|txt|sh|awk|md|yaml|urdf)$|/[^.]*$' | grep -v '/LICENSE$' |
    tr '\n' '\0' | xargs -0 awk -v rooms="$rooms" -f "$here/lines.awk"
  core_headers_without_a_test
  core_headers_not_in_the_umbrella
  dead_links
}

core_headers() {
  files | sed -n 's#^\./core/repel/\(.*/.*\)\.hpp$#\1#p'
}

core_headers_without_a_test() {
  for header in $(core_headers); do
    [ -e "tests/${header}_test.cpp" ] ||
      echo "core/repel/$header.hpp:1: [test-beside] tests/${header}_test.cpp does not exist"
  done
}

core_headers_not_in_the_umbrella() {
  reached=$(included_from_the_umbrella)
  for header in $(core_headers); do
    echo "$reached" | grep -qxF "repel/$header.hpp" ||
      echo "core/repel/$header.hpp:1: [umbrella] repel/repel.hpp does not lead to it"
  done
}

# Every core header that repel/repel.hpp includes, directly or through others.
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
