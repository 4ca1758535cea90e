#pragma once

#include <string>

namespace gatelight::apps {

/// The library that --oidn names, else that of the environment variable GATELIGHT_OIDN; empty: none is named.
std::string oidn_place(const std::string& flag = "");

/// "0.1.0", or "0.1.0 (1a2b3c4)" with the revision where the build has one.
std::string version();

/// "Open Image Denoise 2.5.1, FILE", or why it is not there.
std::string denoiser_text();

}  // namespace gatelight::apps
