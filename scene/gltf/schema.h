#pragma once
// Checks the JSON of a glTF file before anything else reads it. A table gives type, range and length of every
// property that the loader uses, and the list that an index refers to.

#include <nlohmann/json.hpp>

#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "scene/gltf/error.h"

namespace gatelight::scene::gltf {

enum class Kind : unsigned char {
  boolean,
  integer,
  number,
  string,
  index,
  object,
  anything  ///< kept without a check
};
enum class Shape : unsigned char {
  single,
  list,
  lists,     ///< a list of lists, each of Rule::length
  elements,  ///< a list whose elements are checked where something refers to them
  dictionary
};

/// One property of one kind of object.
struct Rule {  // NOLINT(clang-analyzer-optin.performance.Padding): in the order in which the table's rows
               // read best
  std::string_view owner;
  std::string_view name;
  Kind kind = Kind::object;
  /// Kind::index: the list that the index refers to. Kind::object: the owner name of the object's rules.
  /// Kind::string and Kind::integer: the allowed values, separated by '|'; empty allows all.
  std::string_view target{};
  Shape shape = Shape::single;
  bool required = false;
  int length = 0;  ///< number of elements of a list; 0 allows any
  double low = -std::numeric_limits<float>::max();
  double high = std::numeric_limits<float>::max();
  bool lenient = false;  ///< a wrong value counts as missing, with a warning
};

/// The whole table (schema_rules.cpp), with the members of a material that extensions have
/// (scene/material_fields.h).
std::span<const Rule> schema_rules();

/// Checks all that the given scene shows (-1: the file's default, or its first) and these animations of it,
/// and keeps only checked values: members without a rule are erased, and elements of the root's lists to
/// which nothing refers become placeholders. Unifies its numbers: integer properties are stored as unsigned
/// integers (1.0 becomes 1), all others as double, so that no later reader truncates. Throws InputError.
/// Channels of animations become as join_samplers() describes.
void check_schema(nlohmann::json& root, int scene, const std::vector<std::size_t>& animations,
                  std::string_view file, Warnings& warnings);

}  // namespace gatelight::scene::gltf
