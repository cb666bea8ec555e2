# SPDX-License-Identifier: BSD-3-Clause
# A Debian package of what is installed, with what Debian wants of one: `cmake/package/debian BUILD`
# makes and checks it.
include(GNUInstallDirs)

set(completions ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES cmake/package/completion.bash RENAME teleop DESTINATION ${completions})
foreach(program qualify robot_info cover)  # bash looks for a file with the name of the command
  install(CODE "
    set(completion \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${completions}/${program}\")
    file(CREATE_LINK teleop \"\${completion}\" SYMBOLIC)")
endforeach()
# Made by cmake/package/debian.
install(DIRECTORY ${PROJECT_BINARY_DIR}/papers/man1 DESTINATION ${CMAKE_INSTALL_MANDIR} OPTIONAL)
install(DIRECTORY ${PROJECT_BINARY_DIR}/papers/doc/ DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME repel)
set(CPACK_PACKAGE_VENDOR "repel developers")
set(REPEL_PACKAGER "repel developers <repel@example.org>" CACHE STRING
    "Who makes the Debian package, and answers for it")
set(CPACK_PACKAGE_CONTACT ${REPEL_PACKAGER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "virtual force feedback in hard real time")
string(CONCAT CPACK_PACKAGE_DESCRIPTION
       "Distances between convex parts, the way out where they overlap, and the\n"
       "forces that come of it, in every tick of a teleoperated robot. A header\n"
       "library, and programs that simulate an arm.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS libeigen3-dev)
# Debian wants the licence in `copyright` alone.
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/package/without_license.cmake)
include(CPack)
