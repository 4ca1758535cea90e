# Install rules and the exported package. find_package(gatelight) gives gatelight::base, gatelight::scene,
# gatelight::neural and gatelight::renderer.
#
# The components are those of the packages: gatelight (the program and all that belongs to it, also files that other
# folders install without naming a component), openimageio, mpi, dev, python and bench.
include(CMakePackageConfigHelpers)

set(GATELIGHT_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/gatelight)

install(TARGETS gatelight RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
if(TARGET gatelight-mpi)
  install(TARGETS gatelight-mpi RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT mpi)
endif()
if(TARGET gatelight-bench)
  install(TARGETS gatelight-bench gatelight-bench-neural RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT bench)
endif()

foreach(folder IN ITEMS base scene neural renderer)
  if(NOT TARGET gatelight_${folder})
    continue()
  endif()
  install(TARGETS gatelight_${folder} EXPORT gatelight ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gatelight COMPONENT dev)
endforeach()

# Manual pages: help2man makes them of the help.
find_program(GATELIGHT_HELP2MAN help2man)
mark_as_advanced(GATELIGHT_HELP2MAN)
if(GATELIGHT_HELP2MAN AND NOT CMAKE_CROSSCOMPILING)
  set(manual ${PROJECT_BINARY_DIR}/man1)
  set(pages ${manual}/gatelight.1)
  foreach(subcommand IN ITEMS render compare info merge denoise view sweep)
    list(APPEND pages ${manual}/gatelight-${subcommand}.1)
  endforeach()
  add_custom_command(OUTPUT ${pages} COMMAND ${CMAKE_CURRENT_LIST_DIR}/write-manual $<TARGET_FILE_DIR:gatelight> ${pages}
    DEPENDS gatelight ${CMAKE_CURRENT_LIST_DIR}/write-manual VERBATIM)
  add_custom_target(gatelight_manual ALL DEPENDS ${pages})
  install(FILES ${pages} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  if(TARGET gatelight-mpi)
    file(WRITE ${manual}/gatelight-mpi.1 ".so man1/gatelight.1\n")
    install(FILES ${manual}/gatelight-mpi.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT mpi)
  endif()
else()
  message(STATUS "No manual pages: help2man is not there, or the program does not run on this machine")
endif()
# bash and fish look for a script by the program's name; that for zsh names its programs.
set(shell ${PROJECT_SOURCE_DIR}/apps/shell)
install(FILES ${shell}/gatelight.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions RENAME _gatelight)
foreach(program IN ITEMS gatelight gatelight-mpi)
  if(NOT TARGET ${program})
    continue()
  endif()
  set(component gatelight)
  if(program STREQUAL gatelight-mpi)
    set(component mpi)
  endif()
  install(FILES ${shell}/gatelight.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
    RENAME ${program} COMPONENT ${component})
  install(FILES ${shell}/gatelight.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
    RENAME ${program}.fish COMPONENT ${component})
endforeach()

install(TARGETS gatelight_openimageio LIBRARY DESTINATION ${GATELIGHT_PLUGIN_FOLDER} COMPONENT openimageio)
if(GATELIGHT_OIDN_FOLDER)
  file(GLOB oidn ${GATELIGHT_OIDN_FOLDER}/libOpenImageDenoise*.so.*)
  if(NOT oidn)
    message(FATAL_ERROR "'${GATELIGHT_OIDN_FOLDER}' (GATELIGHT_OIDN_FOLDER) has no Open Image Denoise: scripts/setup fetches it")
  endif()
  # The libraries look for each other in ../lib, so their folder has this name.
  install(FILES ${oidn} DESTINATION ${GATELIGHT_PLUGIN_FOLDER}/oidn/lib)
  install(FILES LICENSE scripts/packages/THIRD-PARTY DESTINATION ${GATELIGHT_PLUGIN_FOLDER}/oidn)
endif()
install(EXPORT gatelight FILE gatelightTargets.cmake NAMESPACE gatelight:: DESTINATION ${GATELIGHT_PACKAGE_DIR}
  COMPONENT dev)
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/gatelightConfig.cmake.in ${PROJECT_BINARY_DIR}/gatelightConfig.cmake
  INSTALL_DESTINATION ${GATELIGHT_PACKAGE_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gatelightConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/gatelightConfig.cmake
  ${PROJECT_BINARY_DIR}/gatelightConfigVersion.cmake
  DESTINATION ${GATELIGHT_PACKAGE_DIR} COMPONENT dev)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(PROJECT_IS_TOP_LEVEL)
  include(Deb)
endif()
