#pragma once
// The supported extensions, and access to those that tinygltf returns as generic values.

#include <string>

#include "scene/gltf/error.h"
#include "scene/gltf/tinygltf.h"

namespace gatelight::scene::gltf {

/// Throws SceneError for an unsupported required extension; adds a warning for each unsupported used one.
void check_extensions(const tinygltf::Model& model, std::string_view file, Warnings& warnings);

/// The extension's object, or null. The schema check guarantees that it is an object.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const std::string& name);

/// A member of an extension, or `fallback` if it is missing. The schema check guarantees the type.
double number_or(const tinygltf::Value& object, const std::string& name, double fallback);
int integer_or(const tinygltf::Value& object, const std::string& name, int fallback);
std::string text_or(const tinygltf::Value& object, const std::string& name, const std::string& fallback);

}  // namespace gatelight::scene::gltf
