#pragma once

#include <string>

namespace gatelight::apps {

/// "0.1.0", or "0.1.0 (1a2b3c4)" with the revision where the build has one.
std::string version();

}  // namespace gatelight::apps
