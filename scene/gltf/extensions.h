#pragma once
// Which extensions are known, and reading the ones that tinygltf hands over as generic values.

#include <string>

#include "scene/gltf/error.h"
#include "scene/gltf/tinygltf.h"

namespace gatelight::scene::gltf {

/// Throws SceneError for an unknown required extension; warns once for each unknown used one.
void check_extensions(const tinygltf::Model& model, std::string_view file, Warnings& warnings);

/// The extension's object, or null. The schema has made sure that it is one.
const tinygltf::Value* find_extension(const tinygltf::ExtensionMap& extensions, const std::string& name);

/// Members of an extension; the schema has checked their types.
double number_or(const tinygltf::Value& object, const std::string& name, double fallback);
int integer_or(const tinygltf::Value& object, const std::string& name, int fallback);
std::string text_or(const tinygltf::Value& object, const std::string& name, const std::string& fallback);

}  // namespace gatelight::scene::gltf
