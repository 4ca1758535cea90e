#pragma once

#include <string>

namespace gatelight::renderer {

/// A display and view of an OpenColorIO configuration.
struct OcioView {
  std::string config;   ///< file; empty: Gatelight's own curves
  std::string display;  ///< empty: the configuration's default
  std::string view;     ///< empty: the display's default
};

}  // namespace gatelight::renderer
