option(GATELIGHT_FAST_BUILD "Builds from nothing are faster: heavy headers are parsed once, sources compiled together" OFF)

# gatelight_precompile(<target> <header>...)
#
# Precompiles headers for the target. Sources still include what they use: the other presets precompile nothing and find
# a missing include.
function(gatelight_precompile target)
  if(GATELIGHT_FAST_BUILD)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# gatelight_compile_together(<target>)
#
# Compiles eight sources of the target at a time to one object, because their includes take longer than their own code.
# Their unnamed namespaces become one, so neighbours must not have two functions or constants of the same name. A source
# with the property SKIP_UNITY_BUILD_INCLUSION is compiled separately.
function(gatelight_compile_together target)
  if(GATELIGHT_FAST_BUILD)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE BATCH UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()
