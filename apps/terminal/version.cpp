#include "apps/terminal/version.h"

#include <fmt/format.h>

#include <cstdlib>

#include "gatelight_revision.inc"
#include "renderer/denoise/oidn_library.h"
#include "renderer/machine/errors.h"

namespace gatelight::apps {

std::string version() {
  const std::string revision = kRevision;
  return revision.empty() ? GATELIGHT_VERSION : GATELIGHT_VERSION " (" + revision + ")";
}

std::string denoiser_text() {
  try {
    const char* const library = std::getenv(kOidnVariable);
    const renderer::OidnLibrary& oidn = renderer::load_oidn(library ? library : "");
    return fmt::format("Open Image Denoise {}, {}", oidn.version, oidn.path);
  } catch (const renderer::MissingDenoiser& error) {
    return fmt::format("none: {}", error.what());
  }
}

}  // namespace gatelight::apps
