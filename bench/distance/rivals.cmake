# SPDX-License-Identifier: BSD-3-Clause
# What every program needs that measures libraries side by side: repel_bench_compare, and in
# repel_bench_rivals the libraries beside ours that this machine has. measured_in_tests are ours
# and those from Debian, so that the tests are the same everywhere.
add_library(repel_bench_compare STATIC
  distance/program.cpp distance/measurement.cpp distance/task.cpp distance/truth.cpp)
target_link_libraries(repel_bench_compare PUBLIC repel_bench_harness)
target_include_directories(repel_bench_compare PUBLIC distance ${PROJECT_SOURCE_DIR}/tests)
add_library(repel_bench_rivals INTERFACE)
target_link_libraries(repel_bench_rivals INTERFACE repel_bench_compare)

# repel_rival(NAME FOUND HOW [VERSION version] [INCLUDES dir...] [LIBRARIES lib...]): one library to
# measure ours against. Where FOUND is false it is left out, and HOW says how to have it.
set(absent "")
set(built "")
function(repel_rival name found how)
  cmake_parse_arguments(ARG "" "VERSION" "INCLUDES;LIBRARIES" ${ARGN})
  if(NOT found)
    message(STATUS "repel: ${name} is not measured. To have it: ${how}")
    set(absent "${absent}${name} is not measured. To have it: ${how}\\n" PARENT_SCOPE)
    return()
  endif()
  set(built ${built} ${name} PARENT_SCOPE)
  add_library(rival_${name} OBJECT distance/rivals/${name}.cpp)
  if(ARG_VERSION)
    target_compile_definitions(rival_${name} PRIVATE REPEL_RIVAL_VERSION="${ARG_VERSION}")
  endif()
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

# What is in no package is compiled from its sources, wherever they are.
set(REPEL_OPENGJK_DIR "" CACHE PATH "Sources of openGJK, to measure it")
set(REPEL_DGD_DIR "" CACHE PATH "Sources of dgd, differentiable growth distance, to measure it")
set(REPEL_BOX3D_DIR "" CACHE PATH "Sources of Box3D, to measure it")
set(REPEL_DRAKE_DIR "" CACHE PATH "Sources of Drake, to measure its library with their headers")

# repel_sources(VARIABLE OUT VERSIONED FILES...): the folder that VARIABLE names, if any, must have
# FILES. OUT is the version that the project in its file VERSIONED states, or unknown.
function(repel_sources variable out versioned)
  set(folder "${${variable}}")
  set(version unknown)
  if(folder)
    foreach(file ${ARGN})
      if(NOT EXISTS "${folder}/${file}")
        message(FATAL_ERROR "${variable} is wrong: there is no ${folder}/${file}")
      endif()
    endforeach()
    if(EXISTS "${folder}/${versioned}")
      file(STRINGS "${folder}/${versioned}" line REGEX "^[ \t]*VERSION +[0-9]" LIMIT_COUNT 1)
      if(line MATCHES "([0-9][0-9.]*)")
        set(version ${CMAKE_MATCH_1})
      endif()
    endif()
  endif()
  set(${out} "${version}" PARENT_SCOPE)
endfunction()

repel_sources(REPEL_OPENGJK_DIR opengjk_version scalar/CMakeLists.txt
              scalar/openGJK.c scalar/include/openGJK/openGJK.h)
if(REPEL_OPENGJK_DIR)
  enable_language(C)
  add_library(opengjk STATIC "${REPEL_OPENGJK_DIR}/scalar/openGJK.c")
  target_include_directories(opengjk SYSTEM PUBLIC "${REPEL_OPENGJK_DIR}/scalar/include")
  # Its complaints would be among the tables: the adapter takes them.
  target_compile_definitions(opengjk PRIVATE printf=repel_bench_unheard)
  target_compile_options(opengjk PRIVATE ${flags})
  set_target_properties(opengjk PROPERTIES COMPILE_WARNING_AS_ERROR OFF)
endif()
repel_rival(opengjk "${REPEL_OPENGJK_DIR}"
            "cmake -DREPEL_OPENGJK_DIR=FOLDER, the sources of MattiaMontanari/openGJK on GitHub"
            VERSION "${opengjk_version}" LIBRARIES opengjk)

repel_sources(REPEL_DGD_DIR dgd_version CMakeLists.txt
              include/dgd/solvers/minimum_distance_impl.h)
set(dgd_repository HybridRobotics/differentiable-growth-distance)
repel_rival(dgd "${REPEL_DGD_DIR}"
            "cmake -DREPEL_DGD_DIR=FOLDER, the sources of ${dgd_repository} on GitHub"
            VERSION "${dgd_version}" INCLUDES "${REPEL_DGD_DIR}/include")

repel_sources(REPEL_BOX3D_DIR box3d_version CMakeLists.txt
              src/distance.c src/core.c include/box3d/collision.h)
if(REPEL_BOX3D_DIR)
  enable_language(C)
  add_library(box3d STATIC "${REPEL_BOX3D_DIR}/src/distance.c" "${REPEL_BOX3D_DIR}/src/core.c")
  target_include_directories(box3d SYSTEM PUBLIC "${REPEL_BOX3D_DIR}/include")
  target_compile_options(box3d PRIVATE ${flags})
  set_target_properties(box3d PROPERTIES COMPILE_WARNING_AS_ERROR OFF C_STANDARD 17)
endif()
repel_rival(box3d "${REPEL_BOX3D_DIR}"
            "cmake -DREPEL_BOX3D_DIR=FOLDER, the sources of erincatto/box3d on GitHub"
            VERSION "${box3d_version}" LIBRARIES box3d)

# The wheel of Drake has no headers, and those that its build writes are not among its sources. The
# library asks for others of the wheel, and its loader knows where, but not the linker.
set(drake_version 1.51.1)
set(drake_library ${REPEL_BENCH_PYPI}/pydrake/lib/libdrake.so)
set(drake_include ${CMAKE_CURRENT_BINARY_DIR}/drake)
repel_debian_packages(drake drake_packages)
find_package(fmt QUIET)
repel_sources(REPEL_DRAKE_DIR unused "" geometry/scene_graph.h)
if(REPEL_DRAKE_DIR AND EXISTS ${drake_library} AND fmt_FOUND)
  set(has_drake TRUE)
  file(CONFIGURE OUTPUT ${drake_include}/written/drake/common/autodiff_config.h
       CONTENT "#define DRAKE_INTERNAL_USE_EIGEN_LEGACY_AUTODIFF 1\n")
  file(CREATE_LINK "${REPEL_DRAKE_DIR}" ${drake_include}/drake SYMBOLIC)
endif()
repel_rival(drake "${has_drake}"
            "apt-get install ${drake_packages}, ${from_pypi}, and \
cmake -DREPEL_DRAKE_DIR=FOLDER, the sources of RobotLocomotion/drake ${drake_version} on GitHub"
            VERSION ${drake_version} INCLUDES ${drake_include} ${drake_include}/written
            LIBRARIES ${drake_library} fmt::fmt
                      "-Wl,-rpath-link,${REPEL_BENCH_PYPI}/drake.libs")
target_compile_definitions(repel_bench_rivals INTERFACE REPEL_ABSENT_RIVALS="${absent}")
