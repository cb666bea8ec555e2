# SPDX-License-Identifier: BSD-3-Clause
# Installs every part that was built, the package file and the pkg-config file of the core. A build
# may be of some targets only, as that of ./run: what it left out is named and not installed.
#
# Three components, each a Debian package: `core`, headers that need Eigen alone; `programs`, with
# their scenes, robots and page; and `dev`, all the rest.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME dev)

# repel_say_if_not_built(TARGET COMPONENT FILES...): then FILES, which promise it, are taken away
# again.
function(repel_say_if_not_built target component)
  string(REPLACE ";" " " promises "${ARGN}")
  set(remedy "cmake --build ${PROJECT_BINARY_DIR} --target ${target}")
  install(CODE "
    if(NOT EXISTS \"$<TARGET_FILE:${target}>\")
      message(STATUS \"repel: ${target} is not built, so not installed; to have it: ${remedy}\")
      foreach(pattern ${promises})
        file(GLOB promises \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/\${pattern}\")
        if(promises)
          file(REMOVE \${promises})
        endif()
      endforeach()
    endif()" COMPONENT ${component})
endfunction()

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/repel)
set(REPEL_PACKAGES "")  # a line of the package file for each part: the Debian packages it needs
foreach(part ${REPEL_COMPONENTS})
  repel_debian_packages(${part} packages)
  if(part STREQUAL robots AND REPEL_HAS_MESHES)
    repel_debian_packages(meshes meshes)
    string(APPEND packages " ${meshes}")
  endif()
  if(part STREQUAL robots AND REPEL_HAS_SDF)
    repel_debian_packages(sdf sdf)
    string(APPEND packages " ${sdf}")
  endif()
  if(part STREQUAL robots AND REPEL_HAS_MJCF)
    repel_debian_packages(mjcf mjcf)
    string(APPEND packages " ${mjcf}")
  endif()
  if(part STREQUAL percepts AND REPEL_HAS_PNGS)
    repel_debian_packages(pngs packages)
  endif()
  if(part STREQUAL record AND REPEL_HAS_ZSTD)
    repel_debian_packages(zstd packages)
  endif()
  if(part STREQUAL cover AND REPEL_HAS_HACD)
    repel_debian_packages(hacd packages)
  endif()
  string(APPEND REPEL_PACKAGES "set(repel_packages_${part} \"${packages}\")\n")
  if(TARGET repel_${part})
    set(component dev)
    if(part STREQUAL core)
      set(component core)
    endif()
    install(TARGETS repel_${part} EXPORT repel-${part} OPTIONAL COMPONENT ${component})
    get_target_property(base repel_${part} REPEL_BASE)
    get_target_property(headers repel_${part} REPEL_HEADERS)
    install(DIRECTORY ${base}/${headers}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/${headers}
            COMPONENT ${component} FILES_MATCHING PATTERN *.hpp)
    install(EXPORT repel-${part} NAMESPACE repel:: DESTINATION ${package_dir}
            COMPONENT ${component})
    get_target_property(type repel_${part} TYPE)
    if(NOT type STREQUAL INTERFACE_LIBRARY)
      repel_say_if_not_built(repel_${part} ${component} ${package_dir}/repel-${part}.cmake
                             ${package_dir}/repel-${part}-*.cmake)
    endif()
  endif()
endforeach()
foreach(program teleop qualify robot_info step_response cover)
  if(TARGET ${program})
    install(TARGETS ${program} OPTIONAL COMPONENT programs)
    repel_say_if_not_built(${program} programs)
  endif()
endforeach()
foreach(data scenes robots)
  install(DIRECTORY ${data} DESTINATION ${CMAKE_INSTALL_DATADIR}/repel COMPONENT programs
          FILES_MATCHING PATTERN *.yaml PATTERN *.urdf PATTERN *.stl PATTERN *.obj)
endforeach()
install(FILES docs/foxglove_layout.json DESTINATION ${CMAKE_INSTALL_DATADIR}/repel
        COMPONENT programs)
install(DIRECTORY backends/visual/page/ DESTINATION ${CMAKE_INSTALL_DATADIR}/repel/page
        COMPONENT programs PATTERN bundle EXCLUDE)
if(TARGET repel_visual)  # programs that link it are elsewhere, and so may be the package
  set(page $<INSTALL_PREFIX>/${CMAKE_INSTALL_DATADIR}/repel/page)
  target_compile_definitions(repel_visual
                             INTERFACE $<INSTALL_INTERFACE:REPEL_PAGE_FOLDER="${page}">)
endif()
install(FILES LICENSE TYPE DOC COMPONENT programs)

list(JOIN REPEL_ENGINES " " REPEL_ENGINE_NAMES)
configure_package_config_file(cmake/repel-config.cmake.in repel-config.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(repel-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/repel-config.cmake
              ${PROJECT_BINARY_DIR}/repel-config-version.cmake
              cmake/RepelDependencies.cmake
        DESTINATION ${package_dir} COMPONENT core)

# Relative to the file itself, so that the installed tree can be moved.
set(pkgconfig_dir ${CMAKE_INSTALL_DATADIR}/pkgconfig)
file(RELATIVE_PATH REPEL_PREFIX_FROM_PC /${pkgconfig_dir} /)
string(REGEX REPLACE "/$" "" REPEL_PREFIX_FROM_PC ${REPEL_PREFIX_FROM_PC})
foreach(file repel.pc repel-control.pc)
  configure_file(cmake/${file}.in ${file} @ONLY)
endforeach()
install(FILES ${PROJECT_BINARY_DIR}/repel.pc DESTINATION ${pkgconfig_dir} COMPONENT core)
install(FILES ${PROJECT_BINARY_DIR}/repel-control.pc DESTINATION ${pkgconfig_dir})
