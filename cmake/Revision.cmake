# cmake -DSOURCE=<folder> -DOUTPUT=<header> -P Revision.cmake
#
# Writes the revision of the working tree into a header at build time, only when it has changed. The revision is empty
# where the sources are not a git checkout of their own.
cmake_minimum_required(VERSION 3.25)
set(revision "")
if(EXISTS ${SOURCE}/.git)
  execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=10
    OUTPUT_VARIABLE revision OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT
  "#pragma once\ninline constexpr const char* kRevision = \"@revision@\";\n")
