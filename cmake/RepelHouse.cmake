# SPDX-License-Identifier: BSD-3-Clause
# Flags and folders for what is built in this tree; nothing here reaches a consumer. A static
# library links them as $<BUILD_INTERFACE:repel_house>: they stay out of the installed package.
if(PROJECT_IS_TOP_LEVEL)
  set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
  set(CMAKE_CXX_EXTENSIONS OFF)
  # An error only for the compilers that the tests run with: others warn of more, g++ 14 of what is
  # not so. Off with: cmake --compile-no-warning-as-error.
  string(REGEX MATCH "^[0-9]+" major "${CMAKE_CXX_COMPILER_VERSION}")
  if("${CMAKE_CXX_COMPILER_ID} ${major}" MATCHES "^(GNU 12|Clang 14)$" AND NOT REPEL_BUILD_PYTHON)
    set(CMAKE_COMPILE_WARNING_AS_ERROR ON)
  endif()
  if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
  endif()
endif()

add_library(repel_house INTERFACE)
target_compile_features(repel_house INTERFACE cxx_std_20)
# Contraction would let two compilers, or two paths of one, round differently.
target_compile_options(repel_house INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -ffp-contract=off)
# At -O3 g++ 12 takes a sum of strings for a copy that overlaps itself (its bug 105651).
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_FLAGS_RELEASE MATCHES "-O3")
  target_compile_options(repel_house INTERFACE -Wno-restrict)
endif()
if(REPEL_SANITIZE)
  target_compile_options(repel_house INTERFACE
    -fsanitize=${REPEL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(repel_house INTERFACE -fsanitize=${REPEL_SANITIZE})
  target_compile_definitions(repel_house INTERFACE REPEL_SANITIZED)  # compilers say it differently
endif()

# repel_headers(TARGET [FOLDER]): the headers that users of a target include, those in repel/PART of
# this folder, or in all of repel/ where there is no PART. They are installed with the target. With
# REPEL_HEADERS_ALONE the target headers_alone compiles each of them by itself.
include(GNUInstallDirs)
option(REPEL_HEADERS_ALONE "Offer the target headers_alone" OFF)
if(REPEL_HEADERS_ALONE)
  add_custom_target(headers_alone)
endif()
function(repel_headers target)
  set(base ${CMAKE_CURRENT_SOURCE_DIR})
  if(ARGC GREATER 1)
    set(base ${ARGV1})
  endif()
  string(REGEX REPLACE "^repel_" "" part ${target})
  set(folder repel/${part})
  if(NOT EXISTS ${base}/${folder})
    set(folder repel)
  endif()
  get_target_property(type ${target} TYPE)
  set(scope PUBLIC)
  if(type STREQUAL INTERFACE_LIBRARY)
    set(scope INTERFACE)
  endif()
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${base}>
                                                $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  set_target_properties(${target} PROPERTIES REPEL_BASE ${base} REPEL_HEADERS ${folder})
  if(REPEL_HEADERS_ALONE)
    file(GLOB_RECURSE headers RELATIVE ${base} ${base}/${folder}/*.hpp)
    foreach(header ${headers})
      file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/alone/${header}.cpp
           CONTENT "#include <${header}>\n")
    endforeach()
    list(TRANSFORM headers PREPEND ${PROJECT_BINARY_DIR}/alone/)
    list(TRANSFORM headers APPEND .cpp)
    add_library(${target}_alone OBJECT EXCLUDE_FROM_ALL ${headers})
    target_link_libraries(${target}_alone PRIVATE ${target} repel_house)
    add_dependencies(headers_alone ${target}_alone)
  endif()
endfunction()

# repel_part(PART SOURCES...): the library of a part of this folder, or with INTERFACE its headers.
function(repel_part part)
  add_library(repel_${part} ${ARGN})
  add_library(repel::${part} ALIAS repel_${part})
  set_target_properties(repel_${part} PROPERTIES EXPORT_NAME ${part})
  repel_headers(repel_${part})
endfunction()

# repel_outside_the_tick(TARGET...): pages, reports and devices wait for people and files. More
# than -O1 takes half as long again to compile.
function(repel_outside_the_tick)
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endforeach()
endfunction()

# repel_test(NAME SOURCES a.cpp LIBRARIES repel::core [LABELS threads]): one GoogleTest binary,
# one ctest entry. Suites labelled `threads` also run under the thread sanitizer.
function(repel_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests)
  target_link_libraries(${name} PRIVATE ${ARG_LIBRARIES} GTest::gtest_main repel_house)
  repel_outside_the_tick(${name})  # they prove answers, not times
  # GoogleTest's macros are not ours. A source that runs a tick compiles all of the library: few
  # large ones cost less than many.
  set_target_properties(${name} PROPERTIES CXX_CLANG_TIDY "" UNITY_BUILD_BATCH_SIZE 16)
  add_test(NAME ${name} COMMAND ${name})
  set(timeout 1200)  # ends what hangs
  if(REPEL_SANITIZE)
    set(timeout 2400)
  endif()
  # What passes says nothing, so that the failure is what a log begins with.
  set_tests_properties(${name} PROPERTIES WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    TIMEOUT ${timeout} ENVIRONMENT GTEST_BRIEF=1)
  if(ARG_LABELS)
    set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}")
  endif()
  if("threads" IN_LIST ARG_LABELS)
    add_dependencies(threads_tests ${name})
  endif()
endfunction()
add_custom_target(threads_tests)
