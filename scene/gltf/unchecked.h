#pragma once
// Reads JSON that nothing has checked yet.

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

namespace gatelight::scene::gltf {

/// A member that is a list; else an empty list.
inline const nlohmann::json& list_of(const nlohmann::json& object, const char* name) {
  static const nlohmann::json kNone = nlohmann::json::array();
  const auto found = object.find(name);
  return found == object.end() || !found->is_array() ? kNone : *found;
}

/// A member that is a string; else an empty one.
inline std::string text_of(const nlohmann::json& object, const char* name) {
  const auto found = object.find(name);
  return found == object.end() || !found->is_string() ? std::string() : found->get<std::string>();
}

/// A whole number from 0 to `count` - 1; else nothing.
inline std::optional<std::size_t> index_below(const nlohmann::json& value, std::size_t count) {
  if (!value.is_number()) return std::nullopt;
  const double number = value.get<double>();
  if (!(number >= 0.0 && number < static_cast<double>(count)) || std::floor(number) != number)
    return std::nullopt;
  return static_cast<std::size_t>(number);
}

/// The same of a member.
inline std::optional<std::size_t> index_of(const nlohmann::json& object, const char* name,
                                           std::size_t count) {
  const auto found = object.find(name);
  return found == object.end() ? std::nullopt : index_below(*found, count);
}

}  // namespace gatelight::scene::gltf
