#include "apps/terminal/version.h"

#include "gatelight_revision.inc"

namespace gatelight::apps {

std::string version() {
  const std::string revision = kRevision;
  return revision.empty() ? GATELIGHT_VERSION : GATELIGHT_VERSION " (" + revision + ")";
}

}  // namespace gatelight::apps
