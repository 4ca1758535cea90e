# Finds OpenImageIO and defines OpenImageIO::OpenImageIO: by its own configuration where that works, else by its files.
#
# Debian's own OpenImageIOConfig.cmake cannot be used. It requires the command line tools, which are in a separate
# package (with Qt), and names an include folder of OpenCV that does not exist. Such an error cannot be caught, so the
# configuration is tried once in a project of its own.
include(FindPackageHandleStandardArgs)

if(NOT DEFINED OpenImageIO_CONFIG_WORKS)
  set(trial ${CMAKE_BINARY_DIR}/CMakeFiles/OpenImageIO)
  file(WRITE ${trial}/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\n")
  foreach(name IN ITEMS CMAKE_CXX_COMPILER CMAKE_TOOLCHAIN_FILE CMAKE_PREFIX_PATH OpenImageIO_DIR OpenImageIO_ROOT)
    if(${name})
      file(APPEND ${trial}/CMakeLists.txt "set(${name} \"${${name}}\")\n")
    endif()
  endforeach()
  file(APPEND ${trial}/CMakeLists.txt
    "project(trial CXX)\n"
    "find_package(OpenImageIO ${OpenImageIO_FIND_VERSION} CONFIG REQUIRED)\n"
    "file(WRITE trial.cpp \"\")\n"
    "add_library(trial OBJECT trial.cpp)\n"
    "target_link_libraries(trial OpenImageIO::OpenImageIO)\n")
  execute_process(COMMAND ${CMAKE_COMMAND} -S ${trial} -B ${trial}/build -G ${CMAKE_GENERATOR}
    RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
  string(COMPARE EQUAL "${result}" 0 works)
  set(OpenImageIO_CONFIG_WORKS ${works} CACHE INTERNAL "Whether OpenImageIO's own configuration can be used")
endif()
if(OpenImageIO_CONFIG_WORKS)
  find_package(OpenImageIO ${OpenImageIO_FIND_VERSION} CONFIG REQUIRED)
  find_package_handle_standard_args(OpenImageIO CONFIG_MODE)
  return()
endif()

find_path(OpenImageIO_INCLUDE_DIR OpenImageIO/imageio.h)
find_library(OpenImageIO_LIBRARY OpenImageIO)
find_library(OpenImageIO_Util_LIBRARY OpenImageIO_Util)
mark_as_advanced(OpenImageIO_INCLUDE_DIR OpenImageIO_LIBRARY OpenImageIO_Util_LIBRARY)

if(OpenImageIO_INCLUDE_DIR)
  file(STRINGS ${OpenImageIO_INCLUDE_DIR}/OpenImageIO/oiioversion.h OpenImageIO_VERSION
    REGEX "^#define OIIO_VERSION_(MAJOR|MINOR|PATCH) +[0-9]+")
  list(TRANSFORM OpenImageIO_VERSION REPLACE "^.* ([0-9]+).*" "\\1")
  list(JOIN OpenImageIO_VERSION "." OpenImageIO_VERSION)
endif()
find_package_handle_standard_args(OpenImageIO
  REQUIRED_VARS OpenImageIO_LIBRARY OpenImageIO_Util_LIBRARY OpenImageIO_INCLUDE_DIR
  VERSION_VAR OpenImageIO_VERSION)

if(OpenImageIO_FOUND AND NOT TARGET OpenImageIO::OpenImageIO)
  # Its headers include Imath's.
  find_package(Imath CONFIG REQUIRED)
  add_library(OpenImageIO::OpenImageIO UNKNOWN IMPORTED)
  set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
    IMPORTED_LOCATION ${OpenImageIO_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${OpenImageIO_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES "${OpenImageIO_Util_LIBRARY};Imath::Imath")
endif()
