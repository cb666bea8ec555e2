# SPDX-License-Identifier: BSD-3-Clause
# Decides which parts can be built here. A part whose packages are missing is left out, and the line
# that installs them is printed.
include(RepelDependencies)

# What find_package offers: the target repel::PART of each. A back end is a folder of this name in
# backends/.
set(REPEL_COMPONENTS core compiled ideal devices link dds record robots cover percepts octrees
    bullet ode scene visual)

# repel_debian_packages(PART OUT): the packages debian-packages.txt lists for PART, as one string.
function(repel_debian_packages part out)
  file(STRINGS ${PROJECT_SOURCE_DIR}/cmake/debian-packages.txt lines REGEX "^${part} ")
  set(packages)
  foreach(line ${lines})
    string(REGEX REPLACE "^${part} +([^ ]+).*" "\\1" package ${line})
    list(APPEND packages ${package})
  endforeach()
  list(JOIN packages " " packages)
  set(${out} ${packages} PARENT_SCOPE)
endfunction()

option(REPEL_WITH_PARTS "What REPEL_WITH_PART is by default, for every part but the core" ON)

# repel_switch(PART OUT): whether the part is wanted. What is not is as if its packages were
# missing, but nothing is looked for, and nothing is said about it.
function(repel_switch part out)
  string(TOUPPER ${part} upper)
  if(part STREQUAL core)
    set(REPEL_WITH_CORE ON)
  else()
    option(REPEL_WITH_${upper} "Build ${part}, where its packages are" ${REPEL_WITH_PARTS})
  endif()
  set(REPEL_WITH_${upper} ${REPEL_WITH_${upper}} PARENT_SCOPE)
  set(${out} ${REPEL_WITH_${upper}} PARENT_SCOPE)
endfunction()

function(repel_say_if_left_out part)
  string(TOUPPER ${part} upper)
  if(NOT REPEL_HAS_${upper} AND (NOT DEFINED REPEL_WITH_${upper} OR REPEL_WITH_${upper}))
    repel_debian_packages(${part} packages)
    message(STATUS "repel: ${part} is left out; to have it: apt-get install ${packages}")
  endif()
endfunction()

foreach(part ${REPEL_COMPONENTS})
  repel_switch(${part} wanted)
  if(wanted)
    repel_find(${part})
  endif()
endforeach()
if(NOT REPEL_HAS_CORE)
  repel_debian_packages(core packages)
  message(FATAL_ERROR "repel needs Eigen 3.4 or newer: apt-get install ${packages}")
endif()
if(REPEL_HAS_DDS)
  enable_language(C)  # of what idlc writes
endif()
# What belongs to a part, and can be left out of it.
foreach(extra meshes sdf hacd pngs zstd haply)
  repel_switch(${extra} wanted)
endforeach()
repel_all_found(MESHES REPEL_WITH_MESHES REPEL_HAS_ROBOTS assimp_FOUND ZLIB_FOUND)
repel_all_found(SDF REPEL_WITH_SDF REPEL_HAS_ROBOTS SDFORMAT_FOUND)
repel_all_found(HACD REPEL_WITH_HACD REPEL_HAS_COVER REPEL_HAS_HACD)
repel_all_found(PNGS REPEL_WITH_PNGS REPEL_HAS_PERCEPTS PNG_FOUND)
repel_all_found(ZSTD REPEL_WITH_ZSTD REPEL_HAS_RECORD ZSTD_FOUND)
# The driver of Haply is part of the devices, with the packages of the live view.
repel_all_found(HAPLY REPEL_WITH_HAPLY REPEL_HAS_DEVICES REPEL_HAS_VISUAL)
repel_all_found(OCTREES REPEL_HAS_OCTREES REPEL_HAS_COVER REPEL_HAS_PERCEPTS)
foreach(part ${REPEL_COMPONENTS} meshes hacd sdf pngs zstd haply)
  repel_say_if_left_out(${part})
endforeach()

if(REPEL_BUILD_APPS OR REPEL_BUILD_BENCH)
  find_package(CLI11 QUIET)
  find_package(nlohmann_json QUIET)
  repel_all_found(HOST CLI11_FOUND nlohmann_json_FOUND)
endif()
if(REPEL_BUILD_APPS)
  repel_all_found(TELEOP REPEL_HAS_HOST REPEL_HAS_COMPILED REPEL_HAS_IDEAL REPEL_HAS_LINK
                  REPEL_HAS_PERCEPTS REPEL_HAS_RECORD REPEL_HAS_ROBOTS REPEL_HAS_SCENE)
  repel_say_if_left_out(teleop)
endif()
if(REPEL_BUILD_TESTS)
  find_package(GTest QUIET)
  repel_all_found(TEST REPEL_HAS_COMPILED GTest_FOUND)
  repel_say_if_left_out(test)
endif()
if(REPEL_BUILD_BENCH)
  find_package(benchmark QUIET)
  repel_all_found(BENCH benchmark_FOUND)
  repel_say_if_left_out(bench)
endif()
