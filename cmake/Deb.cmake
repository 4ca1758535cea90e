# Packages of Debian by CPack, one for each component of Package.cmake: 'cpack' in the build folder of the preset
# 'packages' (scripts/packages/build). dpkg-shlibdeps finds the libraries that programs need.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME gatelight)
set(CPACK_PACKAGE_VENDOR Gatelight)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_CONTACT "Gatelight maintainers <gatelight@example.org>")
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE zstd)  # unpacks in a tenth of the time of xz, and is 4 % larger
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_PRE_BUILD_SCRIPTS ${CMAKE_CURRENT_LIST_DIR}/PackageTimes.cmake)

# Packages for two releases of a distribution differ in their libraries, and the later release has the later version.
cmake_host_system_information(RESULT release QUERY DISTRIB_INFO)
set(CPACK_DEBIAN_PACKAGE_RELEASE "1")
if(release_ID AND release_VERSION_ID)
  string(REPLACE debian deb system "${release_ID}${release_VERSION_ID}")
  string(APPEND CPACK_DEBIAN_PACKAGE_RELEASE "~${system}")
endif()
set(same_version "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")

# gatelight_add_deb(<component> NAME <package> SECTION <section> DESCRIPTION <text> [DEPENDS <package>...]
#   [RECOMMENDS <package>...] [SUGGESTS <package>...])
#
# The first line of the description is the summary.
macro(gatelight_add_deb component)
  cmake_parse_arguments(deb "" "NAME;SECTION;DESCRIPTION" "DEPENDS;RECOMMENDS;SUGGESTS" ${ARGN})
  string(TOUPPER ${component} upper)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${deb_DESCRIPTION}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${deb_NAME})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${deb_SECTION})
  foreach(relation IN ITEMS DEPENDS RECOMMENDS SUGGESTS)
    list(JOIN deb_${relation} ", " CPACK_DEBIAN_${upper}_PACKAGE_${relation})
  endforeach()
  install(FILES ${PROJECT_SOURCE_DIR}/scripts/packages/THIRD-PARTY DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${deb_NAME}
    RENAME copyright COMPONENT ${component})
endmacro()

set(CPACK_COMPONENTS_ALL "")
set(summary "offline CPU path tracer for glTF scenes")
string(CONCAT description
  "Gatelight renders glTF scenes by path tracing on the processor, with a neural\n"
  "cache of light on the triangles, and finishes the pictures with a denoiser.\n")
set(denoiser "\nPictures keep their noise where Open Image Denoise, which Debian lacks, is not\ninstalled.")
if(GATELIGHT_OIDN_FOLDER)
  set(denoiser "\nThe denoiser, Open Image Denoise, is in the package, because Debian lacks it.\nThe variable GATELIGHT_OIDN names another one.")
endif()
gatelight_add_deb(gatelight NAME gatelight SECTION graphics
  DESCRIPTION "${summary}\n${description}${denoiser}"
  RECOMMENDS "gatelight-openimageio ${same_version}"
  SUGGESTS xdg-utils libvulkan1)
# Apart, because OpenImageIO depends on more packages than all else together.
gatelight_add_deb(openimageio NAME gatelight-openimageio SECTION graphics
  DESCRIPTION "${summary} (more formats of pictures)\n${description}\nOpenImageIO for the program: it reads and writes Radiance HDR, writes TIFF, scales\npictures for gatelight sweep, and converts colours by OpenColorIO."
  DEPENDS "gatelight ${same_version}")
if(TARGET gatelight-mpi)
  gatelight_add_deb(mpi NAME gatelight-mpi SECTION graphics
    DESCRIPTION "${summary} (several machines)\n${description}\nThe program gatelight-mpi renders one picture on several machines by MPI."
    DEPENDS "gatelight ${same_version}" RECOMMENDS openmpi-bin)
endif()
# The packages of gatelightConfig.cmake, and libwebp.
gatelight_add_deb(dev NAME libgatelight-dev SECTION libdevel
  DESCRIPTION "${summary} (C++ libraries)\n${description}\nStatic libraries, headers and the CMake package gatelight."
  DEPENDS libembree-dev libtbb-dev libeigen3-dev libfmt-dev nlohmann-json3-dev libdraco-dev
    libmeshoptimizer-dev libopenexr-dev libjpeg-dev libpng-dev libwebp-dev
  RECOMMENDS "gatelight-openimageio ${same_version}")
if(GATELIGHT_PYTHON_FOUND AND GATELIGHT_PYTHON_FOLDER)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  gatelight_add_deb(python NAME python3-gatelight SECTION python
    DESCRIPTION "${summary} (Python module)\n${description}\nThe Python module gatelight: scenes and pictures as NumPy arrays."
    DEPENDS "gatelight ${same_version}" "python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR})"
      "python3 (<< ${Python_VERSION_MAJOR}.${next_minor})" python3-numpy
    SUGGESTS python3-matplotlib)
  # Compiled files of Python's are made when the package is installed, and removed with it.
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/deb/postinst @ONLY CONTENT
    "#!/bin/sh\nset -e\nif [ \"$1\" = configure ] && command -v py3compile >/dev/null; then py3compile -p python3-gatelight; fi\n")
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/deb/prerm @ONLY CONTENT
    "#!/bin/sh\nset -e\nif command -v py3clean >/dev/null; then py3clean -p python3-gatelight; fi\n")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/deb/postinst ${PROJECT_BINARY_DIR}/deb/prerm)
endif()
include(CPack)
