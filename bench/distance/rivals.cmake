# What every program needs that measures libraries side by side: repel_bench_compare, and in
# repel_bench_rivals the libraries beside ours that this machine has. measured_in_tests are ours
# and those from Debian, so that the tests are the same everywhere.
add_library(repel_bench_compare STATIC
  distance/program.cpp distance/measurement.cpp distance/task.cpp distance/truth.cpp)
target_link_libraries(repel_bench_compare PUBLIC repel_bench_harness)
target_include_directories(repel_bench_compare PUBLIC distance ${PROJECT_SOURCE_DIR}/tests)
add_library(repel_bench_rivals INTERFACE)
target_link_libraries(repel_bench_rivals INTERFACE repel_bench_compare)

# repel_rival(NAME FOUND HOW [INCLUDES dir...] [LIBRARIES lib...]): one library to measure ours
# against. Where FOUND is false it is left out, and HOW says how to have it.
set(absent "")
set(built "")
function(repel_rival name found how)
  cmake_parse_arguments(ARG "" "" "INCLUDES;LIBRARIES" ${ARGN})
  if(NOT found)
    message(STATUS "repel: ${name} is not measured. To have it: ${how}")
    set(absent "${absent}${name} is not measured. To have it: ${how}\\n" PARENT_SCOPE)
    return()
  endif()
  set(built ${built} ${name} PARENT_SCOPE)
  add_library(rival_${name} OBJECT distance/rivals/${name}.cpp)
  target_include_directories(rival_${name} SYSTEM PRIVATE ${ARG_INCLUDES})
  target_link_libraries(rival_${name} PRIVATE repel_bench_compare ${ARG_LIBRARIES})
  target_sources(repel_bench_rivals INTERFACE $<TARGET_OBJECTS:rival_${name}>)
  target_link_libraries(repel_bench_rivals INTERFACE ${ARG_LIBRARIES})
endfunction()

repel_debian_packages(bench packages)
repel_debian_packages(bullet bullet_packages)
set(from_debian "apt-get install ${packages}")
find_package(fcl QUIET)
foreach(rival ccd ode)
  repel_pkg_config(${rival} ${rival})
endforeach()
repel_rival(libccd "${ccd_FOUND}" "${from_debian}" LIBRARIES PkgConfig::ccd)
repel_rival(fcl "${fcl_FOUND}" "${from_debian}" LIBRARIES fcl)
repel_rival(bullet "${REPEL_HAS_BULLET}" "apt-get install ${bullet_packages}"
             LIBRARIES PkgConfig::BULLET)
repel_rival(ode "${ode_FOUND}" "${from_debian}" LIBRARIES PkgConfig::ode)
string(JOIN "," measured_in_tests repel ${built})

set(from_pypi "bench/publish, which fetches it from PyPI")
set(cmeel ${REPEL_BENCH_PYPI}/cmeel.prefix)
find_library(COAL_LIBRARY coal PATHS ${cmeel}/lib NO_DEFAULT_PATH)
repel_rival(coal "${COAL_LIBRARY}" "${from_pypi}"
            INCLUDES ${cmeel}/include LIBRARIES ${COAL_LIBRARY})

file(GLOB MUJOCO_LIBRARY ${REPEL_BENCH_PYPI}/mujoco/libmujoco.so.*)
repel_rival(mujoco "${MUJOCO_LIBRARY}" "${from_pypi}"
            INCLUDES ${REPEL_BENCH_PYPI}/mujoco/include LIBRARIES ${MUJOCO_LIBRARY})
target_compile_definitions(repel_bench_rivals INTERFACE REPEL_ABSENT_RIVALS="${absent}")
