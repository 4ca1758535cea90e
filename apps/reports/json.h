#pragma once
// Reading JSON files, and numbers that JSON cannot hold.

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

namespace gatelight::apps {

/// Reads a file. Returns a discarded value (is_discarded()) where there is no such file, no JSON in it, or
/// JSON nested more than 32 levels deep, because copying and printing recurse.
nlohmann::ordered_json read_json_file(const std::filesystem::path& path);

/// Null for infinity and NaN, such as the PSNR of equal pictures.
inline nlohmann::ordered_json json_number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
}
inline nlohmann::ordered_json json_number(const std::optional<double>& value) {
  return value ? json_number(*value) : nullptr;
}

}  // namespace gatelight::apps
