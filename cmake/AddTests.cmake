# gatelight_add_tests(<target> LIBRARIES <lib>... [PRECOMPILE <header>...] SOURCES <file>...)
#
# Adds one executable for a folder of tests, and one CTest entry for each of its files NAME_test.cpp. An entry for every
# case would start the program a thousand times. An entry runs the test suites of its file. Its label is the last word
# before _test if that is stat, golden or slow, otherwise "unit".
include(GoogleTest)
function(gatelight_add_tests target)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;PRECOMPILE;SOURCES" ${ARGN})
  if(NOT ARG_SOURCES)
    return()
  endif()
  add_executable(${target} ${ARG_SOURCES})
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES} gatelight_compile_options GTest::gmock GTest::gtest_main)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR})
  # The libraries do the long work, so -O1 is enough here.
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  gatelight_build_fast(${target} <gmock/gmock.h> <gtest/gtest.h> <algorithm> <cmath> <string> <vector> ${ARG_PRECOMPILE})
  target_compile_definitions(${target} PRIVATE
    GATELIGHT_SOURCE_DIR="${PROJECT_SOURCE_DIR}" GATELIGHT_BINARY_DIR="${PROJECT_BINARY_DIR}")
  get_filename_component(folder ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  set(timeout 900)
  if(GATELIGHT_SANITIZE_THREADS)  # the sanitizer checks every access, at a tenth of the speed
    set(timeout 7200)
  endif()
  foreach(source IN LISTS ARG_SOURCES)
    if(NOT source MATCHES "_test\\.cpp$")
      continue()
    endif()
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${source})
    file(STRINGS ${source} lines REGEX "^(TYPED_)?TEST(_F|_P)?\\(")
    set(suites "")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^[A-Z_]+\\( *([A-Za-z0-9_]+).*" "\\1" suite "${line}")
      list(APPEND suites "${suite}")
    endforeach()
    list(REMOVE_DUPLICATES suites)
    list(TRANSFORM suites REPLACE "(.+)" "\\1.*:*/\\1.*:\\1/*" OUTPUT_VARIABLE filters)
    list(JOIN filters ":" filter)
    get_filename_component(name ${source} NAME)
    string(REGEX REPLACE "_test\\.cpp$" "" name "${name}")
    set(label unit)
    if(name MATCHES "_(stat|golden|slow)$")
      set(label ${CMAKE_MATCH_1})
    endif()
    add_test(NAME ${folder}.${name} COMMAND ${target} "--gtest_filter=${filter}"
      "--gtest_output=json:${PROJECT_BINARY_DIR}/messages/${folder}.${name}.json")
    set_tests_properties(${folder}.${name} PROPERTIES LABELS ${label} TIMEOUT ${timeout} FIXTURES_REQUIRED messages)
  endforeach()
endfunction()

# gatelight_run_on_lavapipe(<test>...): the tests see only Mesa's software device, where it is installed.
find_file(GATELIGHT_LAVAPIPE NAMES lvp_icd.${CMAKE_SYSTEM_PROCESSOR}.json lvp_icd.json
  PATHS /usr/share/vulkan/icd.d /usr/local/share/vulkan/icd.d NO_DEFAULT_PATH)
mark_as_advanced(GATELIGHT_LAVAPIPE)
function(gatelight_run_on_lavapipe)
  if(GATELIGHT_LAVAPIPE)
    set_property(TEST ${ARGN} APPEND PROPERTY ENVIRONMENT "VK_DRIVER_FILES=${GATELIGHT_LAVAPIPE}")
  endif()
endfunction()
