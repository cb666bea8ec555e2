# Finds the packages behind the optional parts. A part whose packages are missing is left out, and
# the line that installs them is printed.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)

set(REPEL_COMPONENTS core)

macro(repel_component name packages)
  string(TOUPPER ${name} _upper)
  set(REPEL_HAS_${_upper} TRUE)
  foreach(_found ${ARGN})
    if(NOT ${_found})
      set(REPEL_HAS_${_upper} FALSE)
    endif()
  endforeach()
  if(REPEL_HAS_${_upper})
    list(APPEND REPEL_COMPONENTS ${name})
  else()
    message(STATUS "repel: ${name} is left out; to have it: apt-get install ${packages}")
  endif()
endmacro()

find_package(orocos_kdl QUIET)
find_package(urdfdom QUIET)
pkg_check_modules(TINYXML2 QUIET IMPORTED_TARGET tinyxml2)
repel_component(robots "liborocos-kdl-dev liburdfdom-dev libtinyxml2-dev"
  orocos_kdl_FOUND urdfdom_FOUND TINYXML2_FOUND)

pkg_check_modules(BULLET QUIET IMPORTED_TARGET bullet-float64)
repel_component(bullet "libbullet-dev" BULLET_FOUND)

find_package(yaml-cpp QUIET)
repel_component(scene "libyaml-cpp-dev" yaml-cpp_FOUND)

message(STATUS "repel: components ${REPEL_COMPONENTS}")
