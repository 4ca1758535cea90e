#include "renderer/light/lit_surfaces.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "renderer/image/srgb.h"
#include "renderer/sampling/warp.h"

namespace gatelight::renderer {
namespace {

constexpr int kPairs = 1 << 14;
/// Of a texture.
constexpr std::size_t kTexels = 1 << 16;

/// Triangles that are chosen in proportion to a weight.
class Triangles {
 public:
  struct Point {
    Vec3 position;
    Vec3 normal;
    const scene::Material* material;
  };

  explicit Triangles(const scene::Scene& scene) : scene_(scene) {}

  void add(std::uint32_t instance, std::uint32_t primitive, double weight) {
    if (!(weight > 0.0)) return;
    chosen_.push_back({instance, primitive});
    sums_.push_back(total() + weight);
  }

  double total() const { return sums_.empty() ? 0.0 : sums_.back(); }

  Point sample(float which, const Vec2& where) const {
    const auto found = std::upper_bound(sums_.begin(), sums_.end(), static_cast<double>(which) * total());
    const auto& [instance, primitive] =
        chosen_[std::min(static_cast<std::size_t>(found - sums_.begin()), chosen_.size() - 1)];
    const scene::Instance& placed = scene_.instances[instance];
    const auto [a, b, c] = scene::world_triangle(scene_, placed, primitive);
    const Vec2 weights = sample_uniform_triangle(where);
    return {a + weights.x() * (b - a) + weights.y() * (c - a), scene::world_normal(scene_, placed, primitive),
            &scene_.material_of(placed)};
  }

 private:
  struct Choice {
    std::uint32_t instance;
    std::uint32_t primitive;
  };
  const scene::Scene& scene_;
  std::vector<Choice> chosen_;
  std::vector<double> sums_;
};

/// The mean of an sRGB picture's brightest channel.
double mean_of(const scene::Image& image) {
  const std::size_t channels = static_cast<std::size_t>(image.channels);
  const std::size_t texels = image.pixels.size() / std::max<std::size_t>(channels, 1);
  const std::size_t step = texels / kTexels + 1;
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < texels; i += step, ++count) {
    const auto texel = image.pixels.begin() + static_cast<std::ptrdiff_t>(i * channels);
    sum += static_cast<double>(kSrgbToLinear[*std::max_element(texel, texel + (channels < 3 ? 1 : 3))]);
  }
  return count == 0 ? 0.0 : sum / static_cast<double>(count);
}

double emitted(const scene::Scene& scene, const scene::Material& material) {
  const double factor = static_cast<double>(material.emission.maxCoeff());
  if (!material.emission_texture) return factor;
  const auto texture = static_cast<std::size_t>(material.emission_texture.texture);
  return factor * mean_of(scene.images[static_cast<std::size_t>(scene.textures[texture].image)]);
}

}  // namespace

double lit_radiance(const scene::Scene& scene) {
  Triangles lamps(scene), others(scene);
  std::vector<double> radiance(scene.materials.size());
  for (std::size_t m = 0; m < radiance.size(); ++m) {
    if (scene.materials[m].emits()) radiance[m] = emitted(scene, scene.materials[m]);
  }
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Material& material = scene.material_of(scene.instances[i]);
    if (material.unlit) continue;
    const scene::Mesh& mesh = scene.mesh_of(scene.instances[i]);
    const double each = radiance[static_cast<std::size_t>(mesh.material)];
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const double area = scene::world_area(scene, scene.instances[i], t);
      if (material.emits()) {
        lamps.add(i, t, each * area);
      } else {
        others.add(i, t, area);
      }
    }
  }
  if (lamps.total() == 0.0 || others.total() == 0.0) return 0.0;
  double sum = 0.0;
  for (std::uint64_t i = 0; i < kPairs; ++i) {
    const auto u = [&](std::uint64_t dimension) { return uniform_float(dimension, i); };
    const Triangles::Point lamp = lamps.sample(u(0), {u(1), u(2)});
    const Triangles::Point point = others.sample(u(3), {u(4), u(5)});
    const Vec3 to_lamp = lamp.position - point.position;
    const float squared = to_lamp.squaredNorm();
    if (!(squared > 0.0f)) continue;
    const Vec3 d = to_lamp / std::sqrt(squared);
    float cos_lamp = -lamp.normal.dot(d);
    if (lamp.material->double_sided) cos_lamp = std::abs(cos_lamp);
    float cos_point = point.normal.dot(d);  // nobody sees the inside of a ball
    if (point.material->double_sided) cos_point = std::abs(cos_point);
    if (!(cos_lamp > 0.0f && cos_point > 0.0f)) continue;
    // A point that the lamp nearly touches is at most as bright as the lamp.
    const double each = lamps.total() * static_cast<double>(cos_lamp * cos_point / (kPi * squared));
    sum += std::min(each, radiance[static_cast<std::size_t>(lamp.material - scene.materials.data())]);
  }
  return sum / kPairs;
}

}  // namespace gatelight::renderer
