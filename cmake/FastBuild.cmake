option(GATELIGHT_FAST_BUILD "Builds from nothing are faster: heavy headers are parsed once, sources compiled together" OFF)

# gatelight_precompile(<target> <header>...)
#
# Sources include what they use all the same: the other presets, which precompile nothing, find what is missing.
function(gatelight_precompile target)
  if(GATELIGHT_FAST_BUILD)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()

# gatelight_compile_together(<target> <name> <source>...)
#
# One object of several sources of the target, where what they include takes longer than what they are. Their unnamed
# namespaces become one: two functions of the same name must not meet there. Sources in no group stay alone.
function(gatelight_compile_together target name)
  if(NOT GATELIGHT_FAST_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set_source_files_properties(${ARGN} PROPERTIES UNITY_GROUP ${name})
endfunction()
