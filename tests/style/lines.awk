# SPDX-License-Identifier: BSD-3-Clause
# The rules that can be seen line by line. `rooms` names the rooms of the core, left to right, and
# `runs` the folders of runs/repel/runs.

function breach(rule, what) { printf "%s:%d: [%s] %s\n", FILENAME, FNR, rule, what }

# The room of a header or of an include, 0 when it is in none.
function room_of(path, parts) {
  sub(/.*repel\//, "", path)
  split(path, parts, "/")
  return order[parts[1]]
}

function end_of_header() {
  if (!is_header) return
  if (!has_pragma) print last_file ":1: [pragma-once] #pragma once is missing"
  if (!has_file_comment) print last_file ":1: [file-comment] /// @file is missing"
}

function included_path(line) {
  sub(/^ *# *include *[<"]/, "", line)
  sub(/[>"].*/, "", line)
  return line
}

function check_core_include(path, room) {
  if ($0 ~ /"/ || path !~ /^(repel\/.*|Eigen\/[A-Za-z]+|[a-z_]+)$/)
    breach("core-include", path " is neither of the core, Eigen nor the standard library")
  else if (path ~ /^repel\//) {
    room = room_of(path)
    if (own_room && !room) breach("core-include", path " is in no room of the core")
    if (own_room && room > own_room) breach("include-order", path " is to the right of this room")
  }
}

# The same for the folders of runs/repel/runs.
function folder_of(path, parts) {
  if (!sub(/.*repel\/runs\//, "", path)) return 0
  split(path, parts, "/")
  return place[parts[1]]
}

function check_runs_include(path) {
  if (path !~ /^repel\/runs\//) return
  if (!own_folder) breach("include-order", path " is of runs, and this is none of their folders")
  else if (!folder_of(path)) breach("include-order", path " is in no folder of runs.txt")
  else if (folder_of(path) > own_folder)
    breach("include-order", path " is to the right of this folder")
}

BEGIN {
  count = split(rooms, names, " ")
  for (i = 1; i <= count; i++) order[names[i]] = i
  count = split(runs, names, " ")
  for (i = 1; i <= count; i++) place[names[i]] = i
  open_work = "(^|[^A-Za-z])(TO" "DO|FIX" "ME|XX" "X)([^A-Za-z]|$)"
  machine_path = "(^|[^A-Za-z0-9_.$}])/(home|work|root|Users|mnt|media)/"
}

FNR == 1 {
  end_of_header()
  last_file = FILENAME
  is_header = FILENAME ~ /\.hpp$/
  is_code = FILENAME !~ /\.(md|urdf|yaml)$/
  is_page = FILENAME ~ /\.md$/ && FILENAME !~ /^\.\/bench\/results\//  # which programs write
  is_fenced = 0
  is_core = FILENAME ~ /^\.\/(core|control)\//
  is_library = FILENAME ~ /^\.\/(core|control|robots|backends)\//
  own_room = is_core ? room_of(FILENAME) : 0
  is_runs = FILENAME ~ /^\.\/runs\//
  own_folder = is_runs ? folder_of(FILENAME) : 0
  is_outside_apps = FILENAME !~ /^\.\/apps\//
  is_build = FILENAME ~ /(\/CMakeLists\.txt|\.cmake)$/
  has_pragma = has_file_comment = 0
  if (is_core && is_header && FILENAME !~ /repel\/(repel|control)\.hpp$/ && !own_room)
    breach("core-include", "this header is in no room of the core")
}

{
  columns = $0
  gsub(/[\200-\277]/, "", columns)  # the rest of a character in UTF-8
}
is_code && length(columns) > 100 { breach("line-length", "over 100 columns") }
is_page && /^ *```/ { is_fenced = !is_fenced }
is_page && !is_fenced && !/^(\||    )/ && length(columns) > 100 {
  breach("line-length", "a line of text over 100 columns")
}
$0 ~ open_work { breach("open-work", "finish it, or leave it out") }
$0 ~ machine_path { breach("machine-path", "a path of one machine") }

is_header && /^#pragma once/ { has_pragma = 1 }
is_header && /^\/\/\/ @file/ { has_file_comment = 1 }
is_library && /std::(cout|cerr|clog)|[^a-z_:]printf *\(|[^a-z_]puts *\(/ {
  breach("library-output", "a library does not write to the terminal")
}
is_core && /^ *# *include/ { check_core_include(included_path($0)) }
is_runs && /^ *# *include/ { check_runs_include(included_path($0)) }
is_outside_apps && (/^ *# *include *[<"]([^>"]*\/)?apps\// ||
    is_build && !/^ *#/ && /(^|[^A-Za-z0-9_])apps\/[^ ]|\/apps([^A-Za-z0-9_\/]|$)/) {
  breach("arrow-into-apps", "what others need of a program belongs to a library")
}
FILENAME ~ /^\.\/robots\// &&
    /^ *# *include.*repel\/(bullet|ode|mujoco|ideal|scene|visual|devices)\// {
  breach("include-order", "robots know no back end")
}
FILENAME ~ /^\.\/backends\// && /^ *# *include.*repel\/robots\// {
  breach("include-order", "back ends do not know robots")
}

END { end_of_header() }
