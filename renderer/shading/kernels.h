#pragma once
// The wide kernels and the data that they read, as plain data.

#include <cstdint>

#include "renderer/settings/enums.h"
#include "renderer/shading/block.h"

namespace gatelight::renderer {

/// The lights of a scene for the kernels. The memory belongs to LightArrays.
struct LightArraysPtr {
  static constexpr int kTriangleFloats = 20;
  static constexpr int kPlacedFloats = 16;
  static constexpr int kSunFloats = 6;
  enum class Sky : std::uint8_t { none, constant, picture };

  const float* tree = nullptr;  ///< nodes of LightTree, null without one
  float nearest2 = 0.0f;        ///< LightTree::nearest2
  const float* triangles = nullptr;
  std::uint32_t triangle_count = 0;
  const float* placed = nullptr;  ///< point and spot lights; they follow the triangles in the tree
  std::uint32_t placed_count = 0;
  const float* suns = nullptr;  ///< direction and irradiance
  std::uint32_t sun_count = 0;
  Sky sky = Sky::none;
  bool always_sky = false;  ///< sampled beside other lights, too
  float sky_radiance[3] = {0.0f, 0.0f, 0.0f};
};

/// The tables of the lobes.
struct BsdfTables {
  const float* ggx = nullptr;        ///< GgxTables::values
  const float* ggx_means = nullptr;  ///< GgxTables::means
  const float* sheen = nullptr;      ///< SheenTables::values; null in scenes without sheen
};

/// Russian roulette: paths survive with the probability factor * sqrt(throughput), at most 1. In bright
/// rooms, where long paths carry much light, the throughput itself costs more noise than it saves time
/// (Country Kitchen: a tenth more noise in the same time). The throughput leaves out
/// BsdfSample::radiance_scale, which is no loss. Paths that lose nothing, as between clear panes and mirrors,
/// would never end: after `long_path` scattering events the probability is at most `most`.
struct Roulette {
  float factor = 1.0f;
  float most =
      0.99f;  ///< above the square of an albedo, else the variance of its rooms grows with each event
  int long_path = 64;  ///< events under roulette
};

struct ShadingContext {
  LightArraysPtr lights;
  BsdfTables tables;
  DirectLight direct = DirectLight::mis;
  MisHeuristic heuristic = MisHeuristic::power;
  bool separates_wide = false;  ///< whether the outputs of the wide lobes are wanted
  float min_roughness = 0.0f;   ///< perceptual; narrower lobes are not wide (Bsdf::has_narrow)
  /// Light, direction and roulette are those of the narrow lobes (Bsdf::narrow_part); separates_wide is set,
  /// for the albedos.
  bool narrow_only = false;
  Roulette roulette;
};

struct ShadingKernels {
  /// Chooses a light for each lane and samples a point on it: Lights::sample.
  void (*sample_lights)(ShadingBlock&, const ShadingContext&);
  /// Sets up the BSDF, evaluates it towards the light, samples a direction and decides on survival: Bsdf,
  /// Lights, MisRule, and Russian roulette.
  void (*scatter)(ShadingBlock&, const ShadingContext&);
  /// Computes only the directional albedo.
  void (*albedo)(ShadingBlock&, const ShadingContext&);
  /// Computes the albedos and the light of the light samples: a part of `scatter`.
  void (*light)(ShadingBlock&, const ShadingContext&);
};

}  // namespace gatelight::renderer
