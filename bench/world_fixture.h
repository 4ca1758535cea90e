#pragma once
// Real scenes that are ready for tracing, loaded once per program.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "bench/bare_embree.h"
#include "renderer/transport/path_integrator.h"

namespace gatelight::bench {

/// A scene of $GATELIGHT_SCENES with the light and camera that the tables use.
struct SceneCase {
  const char* name;
  const char* file;
  const char* camera;
  Color sky;
};

inline const SceneCase kSponza{"sponza", "sponza/sponza.glb", "hall", {1.3f, 1.6f, 2.0f}};
inline const SceneCase kKitchen{"kitchen", "country-kitchen/country-kitchen.glb", "", {0.0f, 0.0f, 0.0f}};

inline const SceneCase kSalle{"salle-de-bain", "salle-de-bain/salle-de-bain.glb", "", {0.0f, 0.0f, 0.0f}};
inline const SceneCase kBistro{"bistro", "bistro-exterior/bistro-exterior.glb", "", {1.3f, 1.6f, 2.0f}};
/// In the repository.
inline const SceneCase kLiving{"living-room", GATELIGHT_DATA "/living-room.glb", "", {0.0f, 0.0f, 0.0f}};

inline constexpr const char* kNoScene = "GATELIGHT_SCENES does not name a folder with this scene";

inline constexpr int kWidth = 640;
inline constexpr int kHeight = 360;
/// Four bounces after the first hit: five scattering events.
inline constexpr int kMaxDepth = 5;

/// Scene and world of one case.
struct WorldFixture {
  explicit WorldFixture(const SceneCase& which);

  /// Camera samples of one pass over the picture, tile by tile as the program makes them.
  std::vector<std::vector<renderer::CameraSample>> tiles(std::uint32_t sample) const;
  /// Built at the first call. Not thread-safe.
  const BareEmbree& bare(Watertight watertight = Watertight::robust) const;

  scene::Scene scene;
  renderer::RenderOptions options;
  renderer::World world;

 private:
  mutable std::unique_ptr<BareEmbree> bare_[2];
};

/// Empty if GATELIGHT_SCENES is not set or its folder does not hold the file.
std::filesystem::path file_of(const SceneCase& which);

/// Null where file_of() is empty.
const WorldFixture* world(const SceneCase& which);

}  // namespace gatelight::bench
