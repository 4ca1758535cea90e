#pragma once
// What the JSON of a glTF file must look like before anything reads it. tinygltf ignores or misreads values
// of the wrong type; here every property that the loader uses is checked against a table: type, range,
// length, and that indices point to something.

#include <nlohmann/json.hpp>

#include <limits>
#include <span>
#include <string_view>

namespace gatelight::scene::gltf {

enum class Kind : unsigned char { boolean, integer, number, string, index, object };
enum class Shape : unsigned char { single, list, dictionary };

/// One property of one kind of object.
struct Rule {  // NOLINT(clang-analyzer-optin.performance.Padding): in the order in which the table's rows
               // read best
  std::string_view owner;
  std::string_view name;
  Kind kind = Kind::object;
  /// Kind::index: the root's list that is pointed into. Kind::object: the owner name of the object's own
  /// rules. Kind::string and Kind::integer: the allowed values, separated by '|'; empty allows all.
  std::string_view target{};
  Shape shape = Shape::single;
  bool required = false;
  int length = 0;  ///< of a list; 0 allows any
  double low = -std::numeric_limits<float>::max();
  double high = std::numeric_limits<float>::max();
};

/// The whole table (gltf_schema_rules.cpp).
std::span<const Rule> schema_rules();

/// Checks the document and brings its numbers into one form: what the specification calls an integer is
/// stored as one (1.0 becomes 1), all else as a double, so that no later reader truncates. Throws SceneError.
void check_schema(nlohmann::json& root, std::string_view file);

}  // namespace gatelight::scene::gltf
