#pragma once
// The name of a layer without the view that it belongs to.

#include <algorithm>
#include <cctype>
#include <string>

namespace gatelight::renderer {

/// "ViewLayer.Denoising Albedo" -> "denoising albedo"
inline std::string short_name(const std::string& layer) {
  std::string name = layer.substr(layer.rfind('.') + 1);
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  return name;
}

}  // namespace gatelight::renderer
