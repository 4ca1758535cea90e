# One interface target carries the flags of our own code. They do not reach users of the installed package.
add_library(gatelight_compile_options INTERFACE)
target_compile_features(gatelight_compile_options INTERFACE cxx_std_20)
target_compile_options(gatelight_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wno-missing-field-initializers
  -Wno-overlength-strings  # the page of the window is one
  # The same source must give the same bits for every instruction set.
  -ffp-contract=off
  # No code reads errno after a math call, and no floating-point exception is trapped.
  -fno-math-errno -fno-trapping-math)
if(GATELIGHT_PYTHON_FOUND AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Position-independent code is as fast as other code where functions cannot be replaced from outside.
  target_compile_options(gatelight_compile_options INTERFACE -fno-semantic-interposition)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13)
  # These report members of optionals and of half-made structs that nothing reads. g++ 12 has the warning, without them.
  target_compile_options(gatelight_compile_options INTERFACE -Wno-maybe-uninitialized)
endif()
if(GATELIGHT_WARNINGS_AS_ERRORS)
  target_compile_options(gatelight_compile_options INTERFACE -Werror)
endif()
if(GATELIGHT_SANITIZE)
  target_compile_options(gatelight_compile_options INTERFACE
    -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(gatelight_compile_options INTERFACE -fsanitize=address,undefined)
endif()
if(GATELIGHT_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "GATELIGHT_FUZZ needs clang, which has libFuzzer: use the preset 'fuzz'")
  endif()
  # This also checks the bounds of the standard library's vectors.
  target_compile_definitions(gatelight_compile_options INTERFACE _GLIBCXX_ASSERTIONS)
  target_compile_options(gatelight_compile_options INTERFACE
    -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(gatelight_compile_options INTERFACE -fsanitize=fuzzer-no-link,address,undefined)
endif()
if(GATELIGHT_SANITIZE_THREADS)
  target_compile_options(gatelight_compile_options INTERFACE -fsanitize=thread -fno-omit-frame-pointer)
  target_link_options(gatelight_compile_options INTERFACE -fsanitize=thread)
endif()
if(GATELIGHT_COVERAGE)
  # Many threads count, and lost updates would show executed lines as not executed.
  target_compile_options(gatelight_compile_options INTERFACE --coverage -fprofile-update=atomic)
  target_link_options(gatelight_compile_options INTERFACE --coverage)
endif()
