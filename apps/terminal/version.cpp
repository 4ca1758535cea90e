#include "apps/terminal/version.h"

#include <fmt/format.h>

#include <cstdlib>

#include "base/errors.h"
#include "gatelight_revision.inc"
#include "renderer/denoise/oidn_library.h"

namespace gatelight::apps {

std::string version() {
  const std::string revision = kRevision;
  return revision.empty() ? GATELIGHT_VERSION : GATELIGHT_VERSION " (" + revision + ")";
}

std::string oidn_place(const std::string& flag) {
  const char* const variable = std::getenv("GATELIGHT_OIDN");
  return flag.empty() && variable ? variable : flag;
}

std::string denoiser_text() {
  try {
    const std::string place = oidn_place();
    const renderer::OidnLibrary& oidn = renderer::load_oidn(place);
    return fmt::format("Open Image Denoise {}, {}", oidn.version, oidn.path);
  } catch (const MissingDenoiser& error) {
    return fmt::format("none: {}", error.what());
  }
}

}  // namespace gatelight::apps
