#pragma once
// Judges the JSON of a glTF file, before tinygltf reads it.

#include <nlohmann/json.hpp>

#include <string_view>

#include "scene/gltf.h"
#include "scene/gltf/error.h"

namespace gatelight::scene::gltf {

/// Parses the text and checks what the shown scene refers to, as far as that needs no other file: the schema
/// (schema.h), version, extensions, and that every buffer view lies in its buffer. Returns the values that
/// the schema knows. Throws InputError.
nlohmann::json judge(std::string_view text, std::string_view file, const LoadOptions& options,
                     Warnings& warnings);

}  // namespace gatelight::scene::gltf
