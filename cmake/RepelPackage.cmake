# SPDX-License-Identifier: BSD-3-Clause
# Debian packages of what is installed, with what Debian wants of them: `cmake/package/debian BUILD`
# makes and checks them. One for each component: librepel-core-dev, librepel-dev, repel.
include(GNUInstallDirs)

set(completions ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES cmake/package/completion.bash RENAME teleop DESTINATION ${completions}
        COMPONENT programs)
# bash looks for a file with the name of the command.
foreach(program qualify robot_info step_response cover)
  install(CODE "
    set(completion \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${completions}/${program}\")
    file(CREATE_LINK teleop \"\${completion}\" SYMBOLIC)" COMPONENT programs)
endforeach()
# Made by cmake/package/debian.
install(DIRECTORY ${PROJECT_BINARY_DIR}/papers/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} OPTIONAL
        COMPONENT programs)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME repel)
set(CPACK_PACKAGE_VENDOR "repel developers")
set(REPEL_PACKAGER "repel developers <repel@example.org>" CACHE STRING
    "Who makes the Debian packages, and answers for them")
set(CPACK_PACKAGE_CONTACT ${REPEL_PACKAGER})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_COMPONENTS_ALL)

# repel_debian_package(COMPONENT NAME SECTION WHAT [DEPENDS LIST] [RECOMMENDS LIST])
function(repel_debian_package component name section what)
  cmake_parse_arguments(ARG "" "DEPENDS;RECOMMENDS" "" ${ARGN})
  install(DIRECTORY ${PROJECT_BINARY_DIR}/papers/doc/
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} OPTIONAL COMPONENT ${component})
  string(TOUPPER ${component} upper)
  set(CPACK_COMPONENTS_ALL ${CPACK_COMPONENTS_ALL} ${component} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${ARG_DEPENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_RECOMMENDS "${ARG_RECOMMENDS}" PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_DESCRIPTION
      "Distances between convex parts, the way out where they overlap, and the
forces that come of it, in every tick of a teleoperated robot.
.
${what}" PARENT_SCOPE)
endfunction()

repel_debian_package(core librepel-core-dev libdevel
  "These are the headers of the core, which need Eigen and the standard library."
  DEPENDS libeigen3-dev)
repel_debian_package(dev librepel-dev libdevel
  "These are the control loop and all around it, as headers and static libraries."
  DEPENDS "librepel-core-dev (= ${PROJECT_VERSION})" RECOMMENDS "repel (= ${PROJECT_VERSION})")
repel_debian_package(programs repel science
  "These are programs that simulate an arm, measure a machine and cover a mesh.")
# Debian wants the licence in `copyright` alone.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package/without_license.cmake)
include(CPack)
