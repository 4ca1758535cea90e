#include "apps/terminal/version.h"

#include <embree3/rtcore.h>

#include "gatelight_revision.inc"

namespace gatelight::apps {

std::string version() {
  const std::string revision = kRevision;
  return revision.empty() ? GATELIGHT_VERSION : GATELIGHT_VERSION " (" + revision + ")";
}

std::string embree_version() {
  return RTC_VERSION_STRING;
}

}  // namespace gatelight::apps
