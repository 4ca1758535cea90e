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

# gatelight_compile_together(<target> <name> <source>...)
#
# Compiles several sources of the target to one object, where their includes take longer than their own code. Their
# unnamed namespaces become one, so two functions there must not have the same name. Other sources are compiled separately.
function(gatelight_compile_together target name)
  if(NOT GATELIGHT_FAST_BUILD)
    return()
  endif()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${name})
endfunction()

# gatelight_compile_rooms_together(<target> <folder>...)
#
# Does the same for all sources of the target in each folder: one object per folder.
function(gatelight_compile_rooms_together target)
  get_target_property(sources ${target} SOURCES)
  foreach(room IN LISTS ARGN)
    set(of_room ${sources})
    list(FILTER of_room INCLUDE REGEX "^${room}/.*[.]cpp$")
    string(MAKE_C_IDENTIFIER ${room} name)
    gatelight_compile_together(${target} ${name} ${of_room})
  endforeach()
endfunction()
