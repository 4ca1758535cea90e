# Install rules and the exported package. find_package(gatelight) gives gatelight::base, gatelight::scene,
# gatelight::neural and gatelight::renderer.
include(CMakePackageConfigHelpers)

set(GATELIGHT_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/gatelight)

foreach(program IN ITEMS gatelight gatelight-mpi gatelight-bench)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()

foreach(folder IN ITEMS base scene neural renderer)
  if(NOT TARGET gatelight_${folder})
    continue()
  endif()
  install(TARGETS gatelight_${folder} EXPORT gatelight ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/gatelight)
endforeach()

install(TARGETS gatelight_openimageio LIBRARY DESTINATION ${GATELIGHT_PLUGIN_FOLDER})
install(EXPORT gatelight FILE gatelightTargets.cmake NAMESPACE gatelight:: DESTINATION ${GATELIGHT_PACKAGE_DIR})
configure_package_config_file(
  ${CMAKE_CURRENT_LIST_DIR}/gatelightConfig.cmake.in ${PROJECT_BINARY_DIR}/gatelightConfig.cmake
  INSTALL_DESTINATION ${GATELIGHT_PACKAGE_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/gatelightConfigVersion.cmake COMPATIBILITY SameMajorVersion)
install(FILES
  ${PROJECT_BINARY_DIR}/gatelightConfig.cmake
  ${PROJECT_BINARY_DIR}/gatelightConfigVersion.cmake
  DESTINATION ${GATELIGHT_PACKAGE_DIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
