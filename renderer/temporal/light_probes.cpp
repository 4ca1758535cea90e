#include "renderer/temporal/light_probes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/parallel/loops.h"
#include "renderer/sampling/warp.h"
#include "renderer/temporal/surface_change.h"
#include "renderer/transport/scattering.h"

namespace gatelight::renderer {
namespace {

/// Light samples of a point, and directions among them that are followed to the next surface.
constexpr std::uint32_t kSamples = 4, kBounces = 2;
constexpr std::size_t kBlock = 1024;

/// The k-th point of a fixed sequence in the unit square: Roberts 2018, "The unreasonable effectiveness of
/// quasirandom sequences".
Vec2 fixed_point(std::uint32_t k, float shift) {
  constexpr float kGolden = 1.32471795f;
  const float n = static_cast<float>(k) + 0.5f;
  const auto part = [](float x) { return x - std::floor(x); };
  return {part(shift + n / kGolden), part(shift + n / (kGolden * kGolden))};
}

class Prober {
 public:
  explicit Prober(const World& world) : world_(world) {}

  void probe(std::span<const VisiblePoint> points, std::span<Color> light) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].hit) continue;
      const Surface surface = world_.surfaces.at(points[i].hit, -points[i].normal, points[i].width, 0.5f);
      for (std::uint32_t k = 0; k < kSamples; ++k) add_light(i, surface, k, Color::Constant(1.0f / kSamples));
      for (std::uint32_t k = 0; k < kBounces; ++k) add_bounce(i, surface, k);
    }
    trace_shadows(light);
    trace_bounces(light);
    trace_shadows(light);
  }

 private:
  struct Pending {
    std::size_t point;
    Color light;
  };

  void add_light(std::size_t i, const Surface& surface, std::uint32_t k, const Color& weight) {
    const Vec3& n = surface.geometric_normal;
    const float choice = (static_cast<float>(k) + 0.5f) / kSamples;
    const LightSample light = world_.lights.sample(surface.position, n, choice, fixed_point(k, 0.0f));
    const float cosine = n.dot(light.wi);
    if (!(light.pdf > 0.0f) || !(cosine > 0.0f)) return;
    const Color value = weight * light.radiance * (kInvPi * cosine / light.pdf);
    if (!(value > 0.0f).any() || !value.isFinite().all()) return;
    shadows_.push_back(shadow_ray(surface, light, 0));
    pending_.push_back({i, value});
  }

  void add_bounce(std::size_t i, const Surface& surface, std::uint32_t k) {
    const Vec3 local = sample_cosine_hemisphere(fixed_point(k, 0.5f));
    const Vec3 wi = Basis(surface.geometric_normal).to_world(local);
    bounces_.push_back({surface.spawn(wi), kInfinity, wi, 0});
    bounced_.push_back({i, Color::Constant(1.0f / kBounces)});
  }

  void trace_shadows(std::span<Color> light) {
    passed_.resize(shadows_.size());
    world_.accel.transmittance(shadows_, passed_);
    for (std::size_t r = 0; r < shadows_.size(); ++r)
      light[pending_[r].point] += pending_[r].light * passed_[r];
    shadows_.clear();
    pending_.clear();
  }

  void trace_bounces(std::span<Color> light) {
    hits_.assign(bounces_.size(), {});
    world_.accel.intersect(bounces_, hits_, false);
    for (std::size_t r = 0; r < bounces_.size(); ++r) {
      if (!hits_[r]) {
        light[bounced_[r].point] += bounced_[r].light * world_.environment.radiance(bounces_[r].direction);
        continue;
      }
      const Surface surface = world_.surfaces.at(hits_[r], bounces_[r].direction, 0.0f, 0.5f);
      const Color albedo =
          surface.material.base_color * light_through(world_.surfaces.material(hits_[r].instance));
      for (std::uint32_t k = 0; k < kBounces; ++k)
        add_light(bounced_[r].point, surface, k, albedo * bounced_[r].light / kBounces);
    }
    bounces_.clear();
    bounced_.clear();
  }

  const World& world_;
  std::vector<Ray> shadows_, bounces_;
  std::vector<Pending> pending_, bounced_;
  std::vector<Color> passed_;
  std::vector<Hit> hits_;
};

}  // namespace

std::vector<Color> probe_light(const World& world, const std::vector<VisiblePoint>& points) {
  std::vector<Color> light(points.size(), Color::Zero());
  for_each_range(points.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    Prober(world).probe(std::span(points).subspan(begin, end - begin),
                        std::span(light).subspan(begin, end - begin));
  });
  return light;
}

}  // namespace gatelight::renderer
