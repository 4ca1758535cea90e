#pragma once
// The surface at the primary hit, for the output variables: its data, their sum over the samples of a pixel,
// and the layers that are means of it.

#include <array>
#include <cstdint>
#include <variant>

#include "renderer/settings/aovs.h"
#include "renderer/surface/surface.h"

namespace gatelight::renderer {

/// The first surface on the path that is neither a mirror nor clear, for the denoiser: a primary hit on a
/// mirror or glass does not describe the picture. If there is none, it is the last surface on the path.
struct GuideSurface {
  bool hit = false;
  std::int32_t surface = -1;       ///< its number on the path
  Color tint{1.0f, 1.0f, 1.0f};    ///< of the surfaces before it
  Color albedo{0.0f, 0.0f, 0.0f};  ///< times the tint
  Vec3 normal = Vec3::Zero();
};

/// The surface at the primary hit, for the output variables.
struct FirstHit {
  bool hit = false;
  float alpha = 1.0f;  ///< 1 minus the visible share of the background
  Color albedo{0.0f, 0.0f, 0.0f};
  Vec3 normal = Vec3::Zero();
  Vec3 position = Vec3::Zero();
  float depth = 0.0f;  ///< in metres from the eye along the ray
  std::uint32_t instance = kNoInstance;
  std::uint32_t primitive = 0;
  GuideSurface guide;
  bool guided = false;                     ///< cache_radiance is set
  Color cache_radiance{0.0f, 0.0f, 0.0f};  ///< of the path, hit or not, computed only from the cache
  // These come from the first cache query of the path.
  bool queried = false;
  Color answer{0.0f, 0.0f, 0.0f};
  Color node{0.0f, 0.0f, 0.0f};
  float error = 0.0f;
  float training_count = 0.0f;
  float resolution = 0.0f;
};

/// The position is in the file's coordinates. `origin` is the scene's origin.
inline FirstHit first_hit(const Hit& hit, const Surface& surface, const Vec3& origin) {
  FirstHit first;
  first.hit = true;
  first.albedo = surface.material.base_color;
  first.normal = surface.shading_normal;
  first.position = origin + surface.position;
  first.depth = hit.t;
  first.instance = hit.instance;
  first.primitive = hit.primitive;
  first.guide = {true, 0, Color::Ones(), first.albedo, first.normal};
  return first;
}

/// Adds a vector or a colour to a sum.
template <class Number, class Vector>
void accumulate(std::array<Number, 3>& sum, const Vector& v) {
  for (int i = 0; i < 3; ++i) sum[static_cast<std::size_t>(i)] += static_cast<Number>(v[i]);
}

/// Data of primary hits for output variables.
struct FirstHitSum {
  std::array<double, 3> albedo{};
  std::array<double, 3> normal{};
  std::array<double, 3> position{};
  std::array<double, 3> answer{};
  std::array<double, 3> node{};
  std::array<double, 3> cache{};
  double depth = 0.0;
  double error = 0.0;
  double training_count = 0.0;
  double resolution = 0.0;
  std::uint32_t count = 0;  ///< number of samples
  std::uint32_t queried = 0;
  std::uint32_t hits = 0;
  std::uint32_t cached = 0;
  float instance = -1.0f;
  float primitive = -1.0f;

  void add(const FirstHit& first) {
    if (first.guided && first.cache_radiance.isFinite().all()) {
      accumulate(cache, first.cache_radiance);
      ++cached;
    }
    if (count++ == 0 && first.hit) {
      instance = static_cast<float>(first.instance);
      primitive = static_cast<float>(first.primitive);
    }
    if (!first.hit) return;
    accumulate(albedo, first.albedo);
    accumulate(normal, first.normal);
    accumulate(position, first.position);
    depth += static_cast<double>(first.depth);
    ++hits;
    if (!first.queried) return;
    accumulate(answer, first.answer);
    accumulate(node, first.node);
    error += static_cast<double>(first.error);
    training_count += static_cast<double>(first.training_count);
    resolution += static_cast<double>(first.resolution);
    ++queried;
  }
};

/// Layers that are means of primary hits. The background counts as black where samples are counted, as in the
/// beauty layer, so edges stay soft.
struct FirstHitMean {
  Aov aov;
  std::variant<double FirstHitSum::*, std::array<double, 3> FirstHitSum::*> sum;
  std::uint32_t FirstHitSum::*count;
};
inline constexpr FirstHitMean kFirstHitMeans[] = {
    {Aov::albedo, &FirstHitSum::albedo, &FirstHitSum::count},
    {Aov::normal, &FirstHitSum::normal, &FirstHitSum::count},
    {Aov::depth, &FirstHitSum::depth, &FirstHitSum::hits},
    {Aov::position, &FirstHitSum::position, &FirstHitSum::hits},
    {Aov::cache_radiance, &FirstHitSum::cache, &FirstHitSum::cached},
    {Aov::cache_answer, &FirstHitSum::answer, &FirstHitSum::count},
    {Aov::cache_error, &FirstHitSum::error, &FirstHitSum::queried},
    {Aov::training_count, &FirstHitSum::training_count, &FirstHitSum::queried},
    {Aov::resolution, &FirstHitSum::resolution, &FirstHitSum::queried},
    {Aov::nearest_node, &FirstHitSum::node, &FirstHitSum::count},
};

}  // namespace gatelight::renderer
