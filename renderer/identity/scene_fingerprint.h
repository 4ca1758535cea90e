#pragma once
// Whether a scene is the one that a file was made with: digests of all that decides its light. Names,
// cameras and warnings do not.

#include <string>

#include "renderer/settings/environment_options.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// 32 hexadecimal digits for each part, so that a refusal can tell which one differs.
struct SceneFingerprint {
  std::string geometry;     ///< positions, triangles, instances: what the layout of a cache depends on
  std::string attributes;   ///< normals, tangents, texture coordinates, colours of vertices
  std::string materials;    ///< with textures, their pixels, and which mesh has which
  std::string lights;       ///< punctual ones
  std::string environment;  ///< content of its file, or its constant

  friend bool operator==(const SceneFingerprint&, const SceneFingerprint&) = default;
};

/// The parts by name, in the order above: for files.
struct FingerprintPart {
  const char* name;
  std::string SceneFingerprint::*digest;
};
inline constexpr FingerprintPart kFingerprintParts[] = {
    {"geometry", &SceneFingerprint::geometry},       {"attributes", &SceneFingerprint::attributes},
    {"materials", &SceneFingerprint::materials},     {"lights", &SceneFingerprint::lights},
    {"environment", &SceneFingerprint::environment},
};

/// Parallel (oneTBB), the same for any number of threads. Throws std::runtime_error naming the environment's
/// file where it cannot be read.
SceneFingerprint compute_scene_fingerprint(const scene::Scene& scene, const EnvironmentOptions& environment);

/// "geometry, lights": the parts that differ; empty where none does.
std::string differing_parts(const SceneFingerprint& a, const SceneFingerprint& b);

}  // namespace gatelight::renderer
