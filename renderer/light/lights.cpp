#include "renderer/light/lights.h"

#include <algorithm>
#include <cmath>

#include "renderer/light/punctual.h"
#include "renderer/light/triangle_sampling.h"
#include "renderer/sampling/warp.h"

namespace gatelight::renderer {
namespace {

using scene::LightType;
using scene::PunctualLight;

TriangleCorners seen_from(const Vec3& p, const EmissiveTriangle& triangle) {
  TriangleCorners t = triangle.corners;
  t.corner -= p;
  return t;
}

/// The cosine between the normal of the front and the direction from the triangle to the point. It is
/// positive on a side that emits.
float cos_emitted(const EmissiveTriangle& triangle, const Vec3& wi) {
  const float cosine = -wi.dot(triangle.normal);
  return triangle.two_sided ? std::abs(cosine) : cosine;
}

LightBounds bounds_of(const EmissiveTriangle& triangle, double intensity) {
  const TriangleCorners& t = triangle.corners;
  LightBounds bounds;
  bounds.intensity = intensity;
  if (!(intensity > 0.0)) return bounds;
  Box box(t.corner);
  box.extend(Vec3(t.corner + t.edge1));
  box.extend(Vec3(t.corner + t.edge2));
  bounds.centre = box.center();
  for (const Vec3& edge : {Vec3(Vec3::Zero()), t.edge1, t.edge2}) {
    bounds.radius = std::max(bounds.radius, (t.corner + edge - bounds.centre).norm());
  }
  bounds.axis = triangle.normal;
  bounds.two_sided = triangle.two_sided;
  return bounds;
}

LightBounds bounds_of(const PunctualLight& light) {
  LightBounds bounds;
  bounds.centre = light.position;
  bounds.intensity = static_cast<double>(luminance(light.intensity));
  if (light.profile) {
    // The importance is zero beyond the extent, and at least half of the maximum up to it.
    constexpr float kHalf = kPi / 3.0f, kRounding = 0.005f;
    const float extent = light.profile->extent();
    bounds.axis = light.direction;
    bounds.cos_normals = std::cos(std::max(extent - kHalf, 0.0f));
    bounds.cos_emission = std::cos(std::min(extent, kHalf) + kRounding);
  } else if (light.type == LightType::spot) {
    bounds.axis = light.direction;
    bounds.cos_emission = std::clamp(light.cos_outer, 0.0f, 1.0f);
  } else {
    bounds.cos_normals = -1.0f;
  }
  return bounds;
}

/// Chooses one of several equal parts by a random number, and reuses the rest of the number. A deep tree
/// needs more than the 24 bits of one number, so the lowest bits come from another number.
struct Share {
  float size = 0.0f;
  int part = 0;
  double rest = 0.0;

  Share(int parts, float u_select, const Vec2& u) {
    if (parts == 0) return;
    const double scaled =
        (static_cast<double>(u_select) + static_cast<double>(u.x()) * 0x1p-24) * static_cast<double>(parts);
    size = 1.0f / static_cast<float>(parts);
    part = std::min(static_cast<int>(scaled), parts - 1);
    rest = std::clamp(scaled - part, 0.0, 0x1.fffffffffffffp-1);
  }
};

/// Bounds of a light over its `count` states of an open shutter. `bounds`: in the middle; bounds_at(time): at
/// a time.
template <typename BoundsAt>
LightBounds swept(LightBounds bounds, std::size_t count, const BoundsAt& bounds_at) {
  std::vector<LightBounds> states;
  Box box(bounds.centre);
  for (std::size_t state = 0; state < count; ++state) {
    states.push_back(bounds_at(scene::time_of_state(state, count)));
    box.extend(states.back().centre);
  }
  bounds.centre = box.center();
  bounds.radius = 0.0f;
  // The normals of a triangle between two states may lie a little outside the arc between theirs.
  constexpr float kBetween = 0.05f;
  float half_angle = 0.0f;
  for (const LightBounds& state : states) {
    bounds.radius = std::max(bounds.radius, (state.centre - bounds.centre).norm() + state.radius);
    const float cosine = bounds.axis.dot(state.axis);
    const float turn = std::acos(std::clamp(bounds.two_sided ? std::abs(cosine) : cosine, -1.0f, 1.0f));
    half_angle =
        std::max(half_angle, turn + std::acos(std::clamp(state.cos_normals, -1.0f, 1.0f)) + kBetween);
  }
  bounds.cos_normals = half_angle < kPi ? std::cos(half_angle) : -1.0f;
  return bounds;
}

bool shines(const PunctualLight& light) {
  return light.intensity.isFinite().all() && luminance(light.intensity) > 0.0f;
}

}  // namespace

Lights::Lights(const scene::Scene& scene, const Textures& textures, const Environment& environment,
               LightSelection selection, std::optional<bool> constant_sky)
    : environment_(environment), constant_sky_(constant_sky), triangles_(scene, textures) {
  const scene::ShutterMotion& shutter = scene.shutter;
  bool any_moves = false;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const PunctualLight& light = scene.lights[i];
    if (!shines(light)) continue;
    const bool distant = light.type == LightType::directional;
    (distant ? distant_ : placed_).push_back(light);
    if (distant || !shutter.is_open) continue;
    placed_states_.push_back(shutter.lights[i]);
    any_moves |= !shutter.lights[i].empty();
  }
  if (!any_moves) placed_states_.clear();
  if (const std::optional<DistantSun>& sun = environment.distant_sun()) {
    distant_.push_back({.name = "sun",
                        .type = LightType::directional,
                        .intensity = sun->irradiance,
                        .direction = -sun->direction,
                        .rays = scene.environment_rays,
                        .link = scene.environment_link});
  }
  std::vector<LightBounds> bounds;
  bounds.reserve(triangles_.size() + placed_.size());
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    bounds.push_back(bounds_of_triangle(i));
    if (bounds.back().intensity > 0.0) ++emissive_count_;
  }
  for (std::size_t i = 0; i < placed_.size(); ++i) bounds.push_back(bounds_of_placed(i));
  local_ = Local(bounds, selection);
  bounds.erase(bounds.begin(), bounds.begin() + static_cast<std::ptrdiff_t>(triangles_.size()));
  local_placed_ = Local(bounds, selection);
}

LightBounds Lights::bounds_of_triangle(std::size_t number) const {
  const double intensity = triangles_.intensity(number);
  const LightBounds middle = bounds_of(triangles_[number], intensity);
  if (!(intensity > 0.0) || triangles_.count_states(number) == 0) return middle;
  return swept(middle, triangles_.count_states(number), [&](float time) {
    EmissiveTriangle moved;
    return bounds_of(triangles_.at(number, time, moved), intensity);
  });
}

LightBounds Lights::bounds_of_placed(std::size_t number) const {
  const LightBounds middle = bounds_of(placed_[number]);
  if (placed_states_.empty() || placed_states_[number].empty()) return middle;
  return swept(middle, placed_states_[number].size(),
               [&](float time) { return bounds_of(placed_at(number, time)); });
}

PunctualLight Lights::placed_at(std::size_t number, float time) const {
  PunctualLight light = placed_[number];
  if (placed_states_[number].empty()) return light;
  const scene::LightPlace place = scene::light_at(placed_states_[number], time);
  light.position = place.position;
  light.direction = place.direction;
  light.side = place.side;
  return light;
}

Lights::Local::Local(const std::vector<LightBounds>& lights, LightSelection selection) {
  if (selection == LightSelection::tree) {
    tree = LightTree(lights);
  } else {
    std::vector<double> weights;
    weights.reserve(lights.size());
    for (const LightBounds& light : lights) weights.push_back(light.intensity);
    table = AliasTable(weights);
  }
}

bool Lights::Local::reaches(const Vec3& p, const Vec3& n, LightTree::Weights& root) const {
  if (tree.empty()) return !table.empty();
  root = tree.weigh_root(p, n);
  return root.sum > 0.0f;
}

LightTree::Choice Lights::Local::sample(const LightTree::Weights& root, const Vec3& p, const Vec3& n,
                                        double u) const {
  if (!tree.empty()) return tree.sample(root, p, n, u);
  const std::uint32_t light = table.sample(u);
  return {light, table.probability(light)};
}

float Lights::Local::probability(const Vec3& p, const Vec3& n, std::uint32_t light) const {
  return tree.empty() ? table.probability(light) : tree.probability(p, n, light);
}

int Lights::count_distant(const Vec3& n) const {
  int count = 0;
  for (const PunctualLight& light : distant_) {
    if (!(n.dot(light.direction) > 0.0f)) ++count;
  }
  return count;
}

LightSample Lights::sample(const Vec3& p, const Vec3& n, float u_select, const Vec2& u, float time) const {
  LightTree::Weights root{};
  const bool local = local_.reaches(p, n, root);
  const int distant = count_distant(n);
  const bool sky = samples_sky(local || distant > 0);
  const Share share((local ? 1 : 0) + distant + (sky ? 1 : 0), u_select, u);
  if (local && share.part == 0) {
    const LightTree::Choice choice = local_.sample(root, p, n, share.rest);
    const float probability = choice.probability * share.size;
    if (!(probability > 0.0f)) return {};
    if (choice.light < triangles_.size()) return sample_triangle(p, choice.light, probability, u, time);
    return sample_placed(p, choice.light - triangles_.size(), probability, time);
  }
  const int number = share.part - (local ? 1 : 0);
  if (sky && number == distant) return sample_environment(n, share.size, u);
  return sample_distant(n, share.size, number);
}

LightSample Lights::sample_delta(const Vec3& p, const Vec3& n, float u_select, const Vec2& u,
                                 float time) const {
  LightTree::Weights root{};
  const bool local = local_placed_.reaches(p, n, root);
  const Share share((local ? 1 : 0) + count_distant(n), u_select, u);
  if (!local || share.part > 0) return sample_distant(n, share.size, share.part - (local ? 1 : 0));
  const LightTree::Choice choice = local_placed_.sample(root, p, n, share.rest);
  const float probability = choice.probability * share.size;
  return probability > 0.0f ? sample_placed(p, choice.light, probability, time) : LightSample{};
}

LightSample Lights::sample_distant(const Vec3& n, float choice, int number) const {
  for (const PunctualLight& light : distant_) {
    if (n.dot(light.direction) > 0.0f || number-- > 0) continue;
    LightSample sample{-light.direction, kInfinity, light.intensity, choice, true};
    sample.light = static_cast<std::uint32_t>(triangles_.size() + placed_.size() +
                                              static_cast<std::size_t>(&light - distant_.data()));
    return sample;
  }
  return {};
}

LightSample Lights::sample_triangle(const Vec3& p, std::uint32_t light, float choice, const Vec2& u,
                                    float time) const {
  EmissiveTriangle moved;
  const EmissiveTriangle& triangle = triangles_.at(light, time, moved);
  const TriangleCorners t = seen_from(p, triangle);
  const TrianglePoint point = sample_triangle_point(t, triangle.area, u);
  const Vec3 to_light = t.corner + point.barycentrics.x() * t.edge1 + point.barycentrics.y() * t.edge2;
  LightSample sample;
  sample.distance = to_light.norm();
  if (!(point.pdf > 0.0f) || !(sample.distance > 0.0f)) return {};
  sample.wi = to_light / sample.distance;
  const float cosine = cos_emitted(triangle, sample.wi);
  if (!(cosine > 0.0f)) return {};
  sample.pdf = choice * point.pdf;
  if (!point.per_solid_angle) sample.pdf *= sample.distance * sample.distance / cosine;
  if (!(sample.pdf > 0.0f) || !std::isfinite(sample.pdf)) return {};
  sample.radiance = triangles_.radiance(triangle, point.barycentrics);
  sample.offset = triangle.offset;
  sample.cosine = cosine;
  sample.light = light;
  return sample;
}

LightSample Lights::sample_placed(const Vec3& p, std::size_t number, float choice, float time) const {
  if (placed_states_.empty()) return sample_placed(p, number, choice, placed_[number]);
  return sample_placed(p, number, choice, placed_at(number, time));
}

LightSample Lights::sample_placed(const Vec3& p, std::size_t number, float choice,
                                  const PunctualLight& light) const {
  const Vec3 to_light = light.position - p;
  LightSample sample;
  sample.distance = to_light.norm();
  if (!(sample.distance > 0.0f)) return {};
  sample.wi = to_light / sample.distance;
  // Such lights are often placed inside the surface of a lamp or a ceiling.
  sample.offset = 1e-4f * sample.distance;
  sample.radiance = punctual_irradiance(light, sample.wi, sample.distance);
  sample.pdf = choice;
  sample.delta = true;
  sample.light = static_cast<std::uint32_t>(triangles_.size() + number);
  if (!sample.radiance.isFinite().all()) return {};
  return sample;
}

LightSample Lights::sample_environment(const Vec3& n, float choice, const Vec2& u) const {
  LightSample sample;
  sample.distance = kInfinity;
  sample.light = static_cast<std::uint32_t>(triangles_.size() + placed_.size() + distant_.size());
  if (environment_.constant() && !n.isZero(0.0f)) {
    const Vec3 local = sample_cosine_hemisphere(u);
    sample.wi = Basis(n).to_world(local);
    sample.radiance = environment_.mean();
    sample.pdf = choice * pdf_cosine_hemisphere(local.z());
    return sample;
  }
  const EnvironmentSample sky = environment_.sample(u, n);
  sample.wi = sky.wi;
  sample.radiance = sky.radiance;
  sample.pdf = choice * sky.pdf;
  return sample;
}

float Lights::pdf_local(const Vec3& p, const Vec3& n, std::uint32_t light) const {
  const float probability = local_.probability(p, n, light);
  const int suns = count_distant(n);
  return probability / static_cast<float>(1 + suns + (samples_sky(true) ? 1 : 0));
}

LightSample Lights::same_point_from(const Vec3& p, const LightSample& sample, const Vec3& from,
                                    float time) const {
  if (!(sample.distance < kInfinity)) return {};
  if (sample.delta) {
    const float choice = pdf_local(p, Vec3::Zero(), sample.light);
    return sample_placed(p, sample.light - triangles_.size(), choice, time);
  }
  const Vec3 to_light = from + sample.distance * sample.wi - p;
  LightSample seen = sample;
  seen.distance = to_light.norm();
  if (!(seen.distance > 0.0f)) return {};
  seen.wi = to_light / seen.distance;
  EmissiveTriangle moved;
  const EmissiveTriangle& triangle = triangles_.at(sample.light, time, moved);
  seen.cosine = cos_emitted(triangle, seen.wi);
  if (!(seen.cosine > 0.0f)) return {};
  seen.pdf = pdf_triangle(p, Vec3::Zero(), sample.light, triangle, seen.wi, seen.distance);
  return seen;
}

float Lights::pdf_triangle(const Vec3& p, const Vec3& n, std::uint32_t instance, std::uint32_t primitive,
                           const Vec3& wi, float distance, float time) const {
  const std::uint32_t light = triangles_.find(instance, primitive);
  if (light == EmissiveTriangles::kNone || local_.empty()) return 0.0f;
  EmissiveTriangle moved;
  return pdf_triangle(p, n, light, triangles_.at(light, time, moved), wi, distance);
}

float Lights::pdf_triangle(const Vec3& p, const Vec3& n, std::uint32_t light,
                           const EmissiveTriangle& triangle, const Vec3& wi, float distance) const {
  if (!(triangle.area > 0.0f)) return 0.0f;
  const float cosine = cos_emitted(triangle, wi);
  if (!(cosine > 0.0f)) return 0.0f;
  const float choice = pdf_local(p, n, light);
  if (!(choice > 0.0f)) return 0.0f;
  const float pdf = choice * pdf_triangle_point(seen_from(p, triangle), triangle.area, cosine, distance);
  return std::isfinite(pdf) ? pdf : 0.0f;
}

float Lights::pdf_environment(const Vec3& p, const Vec3& n, const Vec3& wi) const {
  LightTree::Weights root{};
  const int others = (local_.reaches(p, n, root) ? 1 : 0) + count_distant(n);
  if (!samples_sky(others > 0)) return 0.0f;
  const float density =
      environment_.constant() && !n.isZero(0.0f) ? pdf_cosine_hemisphere(n.dot(wi)) : environment_.pdf(wi, n);
  return density / static_cast<float>(1 + others);
}

std::size_t Lights::bytes() const {
  return triangles_.bytes() + local_.bytes() + local_placed_.bytes() +
         (placed_.size() + distant_.size()) * sizeof(PunctualLight);
}

}  // namespace gatelight::renderer
