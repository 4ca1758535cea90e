#pragma once
// Finds and loads Open Image Denoise.

#include <string>

#include "renderer/denoise/oidn_api.h"

namespace gatelight::renderer {

struct OidnLibrary {
  std::string path;     ///< of the file that was loaded
  std::string version;  ///< "2.5.1"
  oidn::Api api;
};

/// Loads the library once; it stays loaded. `place` is its file or a folder that has it. Where it is empty,
/// the library is searched in lib/gatelight/oidn/lib of the prefix that the program is installed in, where
/// packages have it, in the cache folder where scripts/setup puts it ($XDG_CACHE_HOME or ~/.cache, then
/// gatelight/oidn-*/lib), in lib/ of that prefix, and by the system's loader, in that order. Throws
/// MissingDenoiser: it is not there, it is not a version 2, or it does not support this processor.
const OidnLibrary& load_oidn(const std::string& place);

/// The first file that load_oidn(place) would try.
std::string find_oidn_file(const std::string& place);

}  // namespace gatelight::renderer
