# Kernels: sources that are compiled once for each instruction set, and chosen once while the program runs.

# The flags of each instruction set. The lowest one has those of the project.
set(GATELIGHT_KERNEL_ISAS scalar)
set(GATELIGHT_KERNEL_FLAGS_scalar "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
  list(APPEND GATELIGHT_KERNEL_ISAS avx2 avx512)
  set(GATELIGHT_KERNEL_FLAGS_avx2 -mavx2 -mfma -mf16c)
  set(GATELIGHT_KERNEL_FLAGS_avx512 -mavx512f -mavx512dq -mavx512bw -mavx512vl -mfma -mf16c
    -mprefer-vector-width=512 -Wno-uninitialized $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # gcc 12 warns of its own headers
endif()

# gatelight_add_kernels(<target> <prefix> <source> TABLE <name> ISA <isa> [FLAGS <flag>...])
#
# Compiles <source> to the object library <prefix>_<isa> and links it to <target>. GATELIGHT_KERNEL_TABLE is <name>.
# Link-time optimisation is off because it could move instructions from one object to another.
function(gatelight_add_kernels target prefix source)
  cmake_parse_arguments(kernels "" "TABLE;ISA" "FLAGS" ${ARGN})
  set(object ${prefix}_${kernels_ISA})
  if(kernels_ISA MATCHES "^(avx512)_")
    set(kernels_ISA ${CMAKE_MATCH_1})
  endif()
  add_library(${object} OBJECT ${source})
  target_include_directories(${object} PRIVATE ${PROJECT_SOURCE_DIR})
  target_link_libraries(${object} PRIVATE gatelight_compile_options)
  target_compile_definitions(${object} PRIVATE GATELIGHT_KERNEL_TABLE=${kernels_TABLE})
  target_compile_options(${object} PRIVATE
    -O3 -fno-exceptions -fno-rtti -fno-stack-protector -Wno-psabi -Wno-shadow
    ${GATELIGHT_KERNEL_FLAGS_${kernels_ISA}} ${kernels_FLAGS})
  set_target_properties(${object} PROPERTIES POSITION_INDEPENDENT_CODE ON INTERPROCEDURAL_OPTIMIZATION OFF)
  target_sources(${target} PRIVATE $<TARGET_OBJECTS:${object}>)
  if(GATELIGHT_FUZZ)  # Kernels read only checked data; instrumented, they would dominate the compile time.
    target_compile_options(${object} PRIVATE -fno-sanitize=all)
  endif()
endfunction()
