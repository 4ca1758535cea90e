#include "renderer/light/emissive_triangles.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "renderer/surface/interpolate.h"
#include "scene/triangle_normal.h"

namespace gatelight::renderer {
namespace {

/// A texture may be bright between the points of an estimate. This part of the texture's mean is added
/// everywhere, so that every emitting triangle can be chosen.
constexpr float kTextureFloor = 0.02f;
constexpr float kCoverageFloor = 0.05f;

Vec3 corner_weights(const EmissiveTriangle& triangle, const Vec2& barycentrics) {
  const float b0 = 1.0f - barycentrics.x() - barycentrics.y();
  return triangle.mirrored ? Vec3(b0, barycentrics.y(), barycentrics.x())
                           : Vec3(b0, barycentrics.x(), barycentrics.y());
}

/// The width in uv units of a quarter of the triangle, which one of four lookups represents.
float quarter_footprint(const scene::Mesh& mesh, const scene::TextureSlot& slot,
                        const std::array<std::uint32_t, 3>& t) {
  const std::vector<Vec2>& uv = uv_set(mesh, slot);
  if (!slot || uv.empty()) return 0.0f;
  const Vec2 e1 = uv[t[1]] - uv[t[0]];
  const Vec2 e2 = uv[t[2]] - uv[t[0]];
  return std::sqrt(0.125f * std::abs(e1.x() * e2.y() - e1.y() * e2.x()));
}

/// `p`: the corners in the file's order.
void place(const std::array<Vec3, 3>& p, const PlacementRounding& rounding, EmissiveTriangle& triangle) {
  const Vec3 &second = p[triangle.mirrored ? 2 : 1], &third = p[triangle.mirrored ? 1 : 2];
  triangle.corners = {p[0], second - p[0], third - p[0]};
  float twice_area = 0.0f;
  triangle.normal = scene::triangle_normal(p[0], second, third, twice_area);
  // A triangle counts as degenerate if its area is not a normal float, which sampling needs.
  triangle.area = std::isnormal(0.5f * twice_area) ? 0.5f * twice_area : 0.0f;
  triangle.offset = rounding_offset(p[0], p[1], p[2], rounding);
}

EmissiveTriangle make_triangle(const scene::Scene& scene, std::uint32_t instance_index,
                               std::uint32_t primitive, const PlacementRounding& rounding) {
  const scene::Instance& instance = scene.instances[instance_index];
  const scene::Material& material = scene.material_of(instance);
  EmissiveTriangle triangle;
  triangle.mirrored = instance.swaps_handedness;
  triangle.emission = material.emission;
  triangle.instance = instance_index;
  triangle.primitive = primitive;
  triangle.two_sided = material.double_sided;
  triangle.plain = !material.emission_texture && material.alpha_mode == scene::AlphaMode::opaque;
  place(scene::world_triangle(scene, instance, primitive), rounding, triangle);
  return triangle;
}

}  // namespace

EmissiveTriangles::EmissiveTriangles(const scene::Scene& scene, const Textures& textures)
    : scene_(scene),
      textures_(textures),
      roundings_(scene.instances.size()),
      first_(scene.instances.size(), kNone) {
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Material& material = scene.material_of(scene.instances[i]);
    if (!material.emits() || material.unlit || scene.instances[i].hidden) continue;
    first_[i] = static_cast<std::uint32_t>(triangles_.size());
    moves_ |= scene::is_blurred(scene, i);
    roundings_[i] = PlacementRounding(scene, i);
    const std::size_t count = scene.mesh_of(scene.instances[i]).triangles.size();
    for (std::uint32_t primitive = 0; primitive < count; ++primitive) {
      triangles_.push_back(make_triangle(scene, i, primitive, roundings_[i]));
    }
  }
  intensities_.resize(triangles_.size());
  tbb::parallel_for(std::size_t{0}, triangles_.size(),
                    [this](std::size_t i) { intensities_[i] = estimate_intensity(triangles_[i]); });
  find_duplicates();
}

EmissiveTriangle EmissiveTriangles::moved_to(const EmissiveTriangle& triangle, float time) const {
  EmissiveTriangle moved = triangle;
  if (!scene::is_blurred(scene_, triangle.instance)) return moved;
  place(scene::world_triangle_at(scene_, triangle.instance, triangle.primitive, time),
        roundings_[triangle.instance], moved);
  return moved;
}

// A ray meets only one of several triangles in the same place, so only the first is sampled. The others have
// no intensity, and find() returns the first for them.
void EmissiveTriangles::find_duplicates() {
  using Key = std::array<float, 10>;
  const auto key_of = [&](const EmissiveTriangle& t) {
    const auto less = [](const Vec3& a, const Vec3& b) {
      return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
    };
    std::array<Vec3, 3> p = scene::world_triangle(scene_, scene_.instances[t.instance], t.primitive);
    if (t.mirrored) std::swap(p[1], p[2]);
    std::rotate(p.begin(), std::min_element(p.begin(), p.end(), less), p.end());
    if (t.two_sided && less(p[2], p[1])) std::swap(p[1], p[2]);
    Key key;
    for (std::size_t i = 0; i < 9; ++i) key[i] = p[i / 3][static_cast<Eigen::Index>(i % 3)];
    key[9] = static_cast<float>(scene_.mesh_of(scene_.instances[t.instance]).material);
    return key;
  };
  std::vector<std::pair<Key, std::uint32_t>> order(triangles_.size());
  tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t i) {
    order[i] = {key_of(triangles_[i]), static_cast<std::uint32_t>(i)};
  });
  tbb::parallel_sort(order.begin(), order.end());
  for (std::size_t i = 1, first = 0; i < order.size(); ++i) {
    if (order[i].first != order[first].first) {
      first = i;
      continue;
    }
    if (same_as_.empty()) {
      same_as_.resize(triangles_.size());
      std::iota(same_as_.begin(), same_as_.end(), 0u);
    }
    same_as_[order[i].second] = order[first].second;
    intensities_[order[i].second] = 0.0;
  }
}

Color EmissiveTriangles::textured_radiance(const EmissiveTriangle& triangle, const Vec2& barycentrics,
                                           float footprint, bool cut_alpha) const {
  const scene::Instance& instance = scene_.instances[triangle.instance];
  const scene::Mesh& mesh = scene_.mesh_of(instance);
  const scene::Material& material = scene_.material_of(instance);
  const std::array<std::uint32_t, 3>& t = mesh.triangles[triangle.primitive];
  const Vec3 weights = corner_weights(triangle, barycentrics);

  Color radiance = triangle.emission;
  if (material.emission_texture) {
    const Vec2 uv = uv_at(mesh, material.emission_texture, t, weights);
    radiance *=
        textures_.lookup(material.emission_texture, Encoding::srgb, uv, footprint, 0.5f).head<3>().array();
  }
  if (material.alpha_mode != scene::AlphaMode::opaque) {
    float alpha = material.base_alpha;
    if (material.base_color_texture) {
      const Vec2 uv = uv_at(mesh, material.base_color_texture, t, weights);
      alpha *= textures_.lookup(material.base_color_texture, Encoding::srgb, uv, footprint, 0.5f).w();
    }
    if (!mesh.colors.empty()) alpha *= interpolate(mesh.colors, t, weights).w();
    if (cut_alpha && material.alpha_mode == scene::AlphaMode::mask) {
      alpha = alpha < material.alpha_cutoff ? 0.0f : 1.0f;
    }
    radiance *= cut_alpha ? std::clamp(alpha, 0.0f, 1.0f) : std::clamp(alpha, kCoverageFloor, 1.0f);
  }
  return radiance;
}

float EmissiveTriangles::area_in_shutter(const EmissiveTriangle& triangle) const {
  float largest = triangle.area;
  const std::size_t count = scene::count_states(scene_, triangle.instance);
  for (std::size_t state = 0; state < count; ++state)
    largest = std::max(largest, moved_to(triangle, scene::time_of_state(state, count)).area);
  return largest > 2.0f * triangle.area ? largest : triangle.area;
}

double EmissiveTriangles::estimate_intensity(const EmissiveTriangle& triangle) const {
  const auto area = static_cast<double>(area_in_shutter(triangle));
  if (!(area > 0.0)) return 0.0;
  if (triangle.plain) return area * static_cast<double>(luminance(triangle.emission));

  const scene::Instance& instance = scene_.instances[triangle.instance];
  const scene::Mesh& mesh = scene_.mesh_of(instance);
  const scene::Material& material = scene_.material_of(instance);
  // The centres of the four sub-triangles between the midpoints of the edges.
  const std::array<Vec2, 4> centres{Vec2(1.0f / 3.0f, 1.0f / 3.0f), Vec2(1.0f / 6.0f, 1.0f / 6.0f),
                                    Vec2(2.0f / 3.0f, 1.0f / 6.0f), Vec2(1.0f / 6.0f, 2.0f / 3.0f)};
  const float footprint =
      quarter_footprint(mesh, material.emission_texture, mesh.triangles[triangle.primitive]);
  Color sum = Color::Zero();
  for (const Vec2& b : centres) sum += 0.25f * textured_radiance(triangle, b, footprint, false);
  if (material.emission_texture) {
    const Color mean = textures_.mean(material.emission_texture, Encoding::srgb).head<3>().array();
    sum += kTextureFloor * triangle.emission * mean;
  }
  return area * static_cast<double>(luminance(sum));
}

std::size_t EmissiveTriangles::bytes() const {
  return triangles_.size() * sizeof(EmissiveTriangle) + intensities_.size() * sizeof(double) +
         (first_.size() + same_as_.size()) * sizeof(std::uint32_t);
}

}  // namespace gatelight::renderer
