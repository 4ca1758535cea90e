option(GATELIGHT_PRECOMPILED_HEADERS "Parse heavy headers once for each library: builds from nothing are faster" OFF)

# gatelight_precompile(<target> <header>...)
#
# Sources include what they use all the same: the other presets, which precompile nothing, find what is missing.
function(gatelight_precompile target)
  if(GATELIGHT_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()
