#pragma once
// Reads the file's JSON. The schema check guarantees the type of every value that is read, and every index.

#include <nlohmann/json.hpp>

#include <string>

#include "base/math.h"

namespace gatelight::scene::gltf {

using nlohmann::json;

inline const json& element(const json& list, int index) {
  return list[static_cast<std::size_t>(index)];
}

/// The object's name, or that of `other` if it has none.
inline std::string name_of(const json& object, const json& other) {
  const std::string name = object.value("name", "");
  return name.empty() ? other.value("name", "") : name;
}

/// A member that is a list of numbers, as a vector of Eigen; `fallback` if it is missing.
template <typename Vector>
Vector vector_or(const json& object, const char* name, Vector fallback) {
  if (const auto list = object.find(name); list != object.end()) {
    for (Eigen::Index i = 0; i < fallback.size(); ++i) {
      fallback(i) = element(*list, static_cast<int>(i)).template get<typename Vector::Scalar>();
    }
  }
  return fallback;
}

}  // namespace gatelight::scene::gltf
