#pragma once
// Digests of all that decides the light of a scene, to check whether a file belongs to it. Names, cameras and
// warnings do not count.

#include <string>

#include "renderer/fingerprint/named_texts.h"
#include "renderer/settings/environment_options.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// 32 hexadecimal digits for each part, so that a refusal can name the part that differs:
///     geometry     positions, triangles, instances: the inputs of a cache's layout
///     attributes   normals, tangents, texture coordinates, vertex colours
///     materials    with textures, their pixels, and the material of each mesh
///     lights       punctual lights
///     environment  content of its file, or its constant
using SceneFingerprint = NamedTexts;

/// Parallel (oneTBB), with the same result for any number of threads. Throws InputError, naming the
/// environment's file, where it cannot be read.
SceneFingerprint compute_scene_fingerprint(const scene::Scene& scene, const EnvironmentOptions& environment);

/// 32 hexadecimal digits of the states of an open shutter, cameras included; empty for a closed one.
std::string shutter_digest(const scene::Scene& scene);

/// 32 hexadecimal digits of a file's content. Throws InputError where it cannot be read.
std::string file_digest(const std::string& path);

}  // namespace gatelight::renderer
