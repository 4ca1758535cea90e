#pragma once
// JSON of earlier runs, and numbers that JSON cannot hold.

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

namespace gatelight::apps {

/// A discarded value (is_discarded()) where there is no such file, no JSON in it, or JSON nested more than 32
/// levels deep: copying and printing values takes a call for each level.
nlohmann::ordered_json read_json_file(const std::filesystem::path& path);

/// Null for infinity and NaN: the PSNR of equal pictures, say.
inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
}
inline nlohmann::ordered_json json_number(const std::optional<double>& value) {
  return value ? json_number(*value) : nullptr;
}

}  // namespace gatelight::apps
