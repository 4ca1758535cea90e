#pragma once
// tinygltf's model of a glTF file, and readers of its generic values. The schema (schema.h) guarantees the
// type of every value that is read, and every index.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "base/math.h"
#include "scene/gltf/tinygltf.h"

namespace gatelight::scene::gltf {

/// Returns at most `length` bytes of buffer `index`, which has this URI.
using ReadBuffer =
    std::function<std::vector<std::uint8_t>(std::size_t index, const std::string& uri, std::size_t length)>;

/// The memory that tinygltf takes for the elements of the root's lists, which can be much more than their
/// text.
std::size_t model_bytes(const nlohmann::json& root);

/// Reads the judged JSON. Buffers without a URI stay empty, and images keep their URI or buffer view. Throws
/// InputError, also that of `read`.
tinygltf::Model read_model(nlohmann::json&& root, std::string_view file, const ReadBuffer& read);

template <typename T>
const T& element(const std::vector<T>& list, int index) {
  return list[static_cast<std::size_t>(index)];
}

/// The names of the compression by meshoptimizer. A view has one of them.
inline constexpr const char* kMeshoptNames[] = {"KHR_meshopt_compression", "EXT_meshopt_compression"};

/// The requested scene, or for -1 the file's default, else its first.
inline int shown_scene(const tinygltf::Model& model, int requested) {
  return requested >= 0 ? requested : std::max(model.defaultScene, 0);
}

/// The extension of an object, or null.
inline const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found == extensions.end() ? nullptr : &found->second;
}

/// A member that is an object, or null. tinygltf drops empty ones.
inline const tinygltf::Value* find_member(const tinygltf::Value& object, const char* name) {
  return object.Has(name) ? &object.Get(name) : nullptr;
}

/// The elements of a member that is a list; none if it is missing. tinygltf drops empty ones.
inline const tinygltf::Value::Array& array_of(const tinygltf::Value& object, const char* name) {
  static const tinygltf::Value::Array kNone;
  return object.Has(name) ? object.Get(name).Get<tinygltf::Value::Array>() : kNone;
}

inline double number_or(const tinygltf::Value& object, const char* name, double fallback) {
  return object.Has(name) ? object.Get(name).GetNumberAsDouble() : fallback;
}

inline float float_or(const tinygltf::Value& object, const char* name, float fallback) {
  return static_cast<float>(number_or(object, name, static_cast<double>(fallback)));
}

inline int integer_or(const tinygltf::Value& object, const char* name, int fallback) {
  return object.Has(name) ? object.Get(name).GetNumberAsInt() : fallback;
}

/// A number of bytes, which may be more than an int holds.
inline std::size_t size_of(const tinygltf::Value& object, const char* name) {
  return static_cast<std::size_t>(number_or(object, name, 0.0));
}

inline std::string text_or(const tinygltf::Value& object, const char* name, const char* fallback) {
  return object.Has(name) ? object.Get(name).Get<std::string>() : fallback;
}

/// A list of numbers as a vector of Eigen; `fallback` if it is empty.
template <typename Vector>
Vector vector_or(const std::vector<double>& list, Vector fallback) {
  if (list.empty()) return fallback;
  for (Eigen::Index i = 0; i < fallback.size(); ++i) {
    fallback(i) = static_cast<typename Vector::Scalar>(list[static_cast<std::size_t>(i)]);
  }
  return fallback;
}

/// A member that is a list of numbers; empty if it is missing.
inline std::vector<double> numbers_of(const tinygltf::Value& object, const char* name) {
  std::vector<double> numbers;
  for (const tinygltf::Value& value : array_of(object, name)) numbers.push_back(value.GetNumberAsDouble());
  return numbers;
}

template <typename Vector>
Vector vector_or(const tinygltf::Value& object, const char* name, Vector fallback) {
  return vector_or(numbers_of(object, name), fallback);
}

}  // namespace gatelight::scene::gltf
