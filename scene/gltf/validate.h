#pragma once
// Judges the JSON of a glTF file, before tinygltf reads it.

#include <nlohmann/json.hpp>

#include <string_view>
#include <vector>

#include "scene/gltf.h"
#include "scene/gltf/channels.h"
#include "scene/gltf/error.h"

namespace gatelight::scene::gltf {

struct ValidatedJson {
  nlohmann::json root;                ///< the values that the schema knows, without animations
  std::vector<Animation> animations;  ///< all of the file
  std::vector<Channel> channels;      ///< those of the chosen animations, for what the scene shows
};

/// Parses the text and checks what the shown scene refers to, as far as that needs no other file: the schema
/// (schema.h), version, extensions, and that every buffer view lies in its buffer. Throws InputError.
ValidatedJson validate(std::string_view text, std::string_view file, const LoadOptions& options,
                       Warnings& warnings);

}  // namespace gatelight::scene::gltf
