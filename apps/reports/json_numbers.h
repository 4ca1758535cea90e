#pragma once
// Numbers that JSON may not have.

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

namespace gatelight::apps {

/// Null for infinity and NaN: the PSNR of equal pictures, say.
inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
}
inline nlohmann::ordered_json json_number(const std::optional<double>& value) {
  return value ? json_number(*value) : nullptr;
}

}  // namespace gatelight::apps
