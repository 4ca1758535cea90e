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
  set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${name})
endfunction()

# gatelight_compile_rooms_together(<target> <folder>...)
#
# The same for all sources of the target that lie in each folder: an object a folder.
function(gatelight_compile_rooms_together target)
  get_target_property(sources ${target} SOURCES)
  foreach(room IN LISTS ARGN)
    set(of_room ${sources})
    list(FILTER of_room INCLUDE REGEX "^${room}/.*[.]cpp$")
    string(MAKE_C_IDENTIFIER ${room} name)
    gatelight_compile_together(${target} ${name} ${of_room})
  endforeach()
endfunction()
