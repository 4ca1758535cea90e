option(GATELIGHT_FAST_BUILD "Builds from nothing are faster: heavy headers are parsed once, sources compiled together" OFF)

# gatelight_build_fast(<target> [<header>...])
#
# Compiles eight sources of the target at a time to one object, because their includes take longer than their own code,
# and precompiles the headers. Sources still include what they use: the other presets find a missing include. The unnamed
# namespaces of eight sources become one, so neighbours must not have two functions or constants of the same name. A
# source with the property SKIP_UNITY_BUILD_INCLUSION is compiled separately.
function(gatelight_build_fast target)
  if(GATELIGHT_FAST_BUILD)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE BATCH UNITY_BUILD_BATCH_SIZE 8)
    if(ARGN)
      target_precompile_headers(${target} PRIVATE ${ARGN})
    endif()
  endif()
endfunction()
