# SPDX-License-Identifier: BSD-3-Clause
# What each part needs beyond the standard library. Included by the build and by the installed
# package alike: a static library still needs its private dependencies where it is linked.
#
# repel_find(PART) finds them by repel_find_PART, if it needs any, and sets REPEL_HAS_PART to say
# whether all of them were there. These are macros because find_package must leave its targets with
# the caller.

macro(repel_find part)
  if(COMMAND repel_find_${part})
    cmake_language(CALL repel_find_${part})
  else()
    repel_all_found(${part})
  endif()
endmacro()

macro(repel_find_core)
  find_package(Eigen3 3.4 QUIET NO_MODULE)
  find_package(Threads QUIET)
  repel_all_found(CORE Eigen3_FOUND Threads_FOUND)
endmacro()

macro(repel_find_devices)
  include(CheckIncludeFileCXX)
  set(CMAKE_REQUIRED_QUIET ON)
  check_include_file_cxx(linux/input.h REPEL_FOUND_LINUX_INPUT)
  unset(CMAKE_REQUIRED_QUIET)
  repel_all_found(DEVICES REPEL_FOUND_LINUX_INPUT)
endmacro()

macro(repel_find_dds)
  find_package(CycloneDDS QUIET)
  # The compiler of its types is a package of its own.
  find_program(REPEL_IDLC idlc)
  mark_as_advanced(REPEL_IDLC)
  repel_all_found(DDS CycloneDDS_FOUND REPEL_IDLC)
endmacro()

macro(repel_find_sealed)
  repel_pkg_config(SODIUM libsodium)
  repel_all_found(SEALED SODIUM_FOUND)
endmacro()

macro(repel_find_robots)
  repel_pkg_config(TINYXML2 tinyxml2)
  find_package(orocos_kdl QUIET)
  find_package(urdfdom QUIET)
  # Only for meshes; where they were built in, they are needed. Debian's assimp links zlib by the
  # name of a file, without its package asking for it.
  find_package(assimp QUIET)
  find_package(ZLIB QUIET)
  if(REPEL_ROBOTS_READ_MESHES)
    set(repel_for_meshes assimp_FOUND ZLIB_FOUND)
  endif()
  # Only for SDF files; where it was built in, it is needed. The target of pkg-config would ask for
  # C++17.
  repel_pkg_config(SDFORMAT sdformat12)
  if(SDFORMAT_FOUND AND NOT TARGET repel_sdformat::sdformat)
    add_library(repel_sdformat::sdformat INTERFACE IMPORTED)
    set_target_properties(repel_sdformat::sdformat PROPERTIES
      INTERFACE_INCLUDE_DIRECTORIES "${SDFORMAT_INCLUDE_DIRS}"
      INTERFACE_LINK_LIBRARIES "${SDFORMAT_LINK_LIBRARIES}")
  endif()
  if(REPEL_ROBOTS_READ_SDF)
    set(repel_for_sdf SDFORMAT_FOUND)
  endif()
  # Only for MJCF files; where it was built in, it is needed.
  repel_find_mujoco_engine()
  if(REPEL_ROBOTS_READ_MJCF)
    set(repel_for_mjcf MUJOCO_FOUND)
  endif()
  repel_all_found(ROBOTS orocos_kdl_FOUND urdfdom_FOUND TINYXML2_FOUND ${repel_for_meshes}
                  ${repel_for_sdf} ${repel_for_mjcf})
endmacro()

macro(repel_find_cover)
  # Only for the engine hacd; where it was built in, it is needed. Bullet's extras have no CMake
  # file for it.
  find_path(REPEL_HACD_INCLUDE_DIR HACD/hacdHACD.h PATH_SUFFIXES bullet)
  find_library(REPEL_HACD_LIBRARY NAMES HACD-float64 HACD)
  mark_as_advanced(REPEL_HACD_INCLUDE_DIR REPEL_HACD_LIBRARY)
  repel_all_found(HACD REPEL_HACD_INCLUDE_DIR REPEL_HACD_LIBRARY)
  if(REPEL_HAS_HACD AND NOT TARGET repel_hacd::hacd)
    add_library(repel_hacd::hacd UNKNOWN IMPORTED)
    set_target_properties(repel_hacd::hacd PROPERTIES
      IMPORTED_LOCATION ${REPEL_HACD_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${REPEL_HACD_INCLUDE_DIR})
  endif()
  if(REPEL_COVER_USES_HACD)
    set(repel_for_hacd REPEL_HAS_HACD)
  endif()
  repel_all_found(COVER ${repel_for_hacd})
endmacro()

macro(repel_find_percepts)
  # Only for recorded depth images; where it was built in, it is needed.
  find_package(PNG QUIET)
  if(REPEL_PERCEPTS_READS_PNG)
    set(repel_for_pngs PNG_FOUND)
  endif()
  repel_all_found(PERCEPTS ${repel_for_pngs})
endmacro()

macro(repel_find_record)
  # Only for compressed recordings; where it was built in, it is needed.
  repel_pkg_config(ZSTD libzstd)
  if(REPEL_RECORD_USES_ZSTD)
    set(repel_for_zstd ZSTD_FOUND)
  endif()
  repel_all_found(RECORD ${repel_for_zstd})
endmacro()

macro(repel_find_octrees)
  repel_pkg_config(OCTOMAP octomap)
  repel_all_found(OCTREES OCTOMAP_FOUND)
endmacro()

macro(repel_find_bullet)
  repel_pkg_config(BULLET bullet-float64)  # plain `bullet` is single precision
  repel_all_found(BULLET BULLET_FOUND)
endmacro()

macro(repel_find_ode)
  repel_pkg_config(ODE ode)
  repel_all_found(ODE ODE_FOUND)
endmacro()

# Sets MUJOCO_FOUND and the target repel_mujoco_engine::mujoco.
macro(repel_find_mujoco_engine)
  # Its CMake file asks for OpenGL, which nothing here draws with.
  find_path(REPEL_MUJOCO_INCLUDE_DIR mujoco/mujoco.h)
  find_library(REPEL_MUJOCO_LIBRARY mujoco)
  mark_as_advanced(REPEL_MUJOCO_INCLUDE_DIR REPEL_MUJOCO_LIBRARY)
  if(REPEL_MUJOCO_INCLUDE_DIR AND REPEL_MUJOCO_LIBRARY)
    set(MUJOCO_FOUND TRUE)
  else()
    set(MUJOCO_FOUND FALSE)
  endif()
  if(MUJOCO_FOUND AND NOT TARGET repel_mujoco_engine::mujoco)
    add_library(repel_mujoco_engine::mujoco UNKNOWN IMPORTED)
    set_target_properties(repel_mujoco_engine::mujoco PROPERTIES
      IMPORTED_LOCATION ${REPEL_MUJOCO_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${REPEL_MUJOCO_INCLUDE_DIR})
  endif()
endmacro()

macro(repel_find_mujoco)
  repel_find_mujoco_engine()
  repel_all_found(MUJOCO MUJOCO_FOUND)
endmacro()

macro(repel_find_scene)
  repel_pkg_config(LIBYAML yaml-0.1)
  repel_all_found(SCENE LIBYAML_FOUND)
endmacro()

macro(repel_find_visual)
  find_package(Boost 1.74 QUIET)
  find_package(nlohmann_json QUIET)
  find_package(OpenSSL 3 QUIET)
  repel_all_found(VISUAL Boost_FOUND nlohmann_json_FOUND OPENSSL_FOUND)
endmacro()

# Sets PREFIX_FOUND and the target PkgConfig::PREFIX.
macro(repel_pkg_config prefix module)
  find_package(PkgConfig QUIET)
  if(PkgConfig_FOUND)
    pkg_check_modules(${prefix} QUIET IMPORTED_TARGET ${module})
  endif()
endmacro()

function(repel_all_found part)
  string(TOUPPER ${part} part)
  set(all TRUE)
  foreach(found ${ARGN})
    if(NOT ${found})
      set(all FALSE)
    endif()
  endforeach()
  set(REPEL_HAS_${part} ${all} PARENT_SCOPE)
endfunction()
