#include "renderer/transport/dark_share.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/parallel/loops.h"
#include "renderer/film/film_samples.h"
#include "renderer/image/auto_exposure.h"
#include "renderer/image/tonemap.h"
#include "renderer/transport/path_integrator.h"

namespace gatelight::renderer {
namespace {

constexpr int kPlaces = 400, kSamples = 16, kBounces = 3;
/// Rays see textures as those of a picture with so many times more rows.
constexpr float kDetail = 16.0f;
/// Of a displayed picture, whose middle grey is 0.18. A screen shows less as black.
constexpr float kBlack = 0.003f;
/// Of a surface's light in the soft sky.
constexpr float kFaint = 0.5f;

/// A place of the picture: what its samples see.
struct Place {
  Color radiance{0.0f, 0.0f, 0.0f};
  std::array<float, kSamples> light{}, glow{};  ///< luminance at the surface, and of its own emission
  std::array<float, kSamples> albedo{};         ///< luminance
  std::array<bool, kSamples> hit{};
};

PathIntegratorOptions paths_of(int bounces) {
  RenderOptions options;
  options.max_depth = bounces;
  return path_integrator_options(options);
}

/// Paths of one place, and the same without bounces.
class Eye {
 public:
  Eye(const World& world, const View& view, const Camera& camera, int width, int height)
      : camera_(view, width, height),
        width_(width),
        lit_(world, paths_of(kBounces)),
        glow_(world, paths_of(0)) {
    camera_.take_surroundings(camera);
  }

  Place look(int number) const {
    const RenderOptions options;
    const FilterSampler filter(PixelFilter::box, 1.0f);
    std::vector<CameraSample> samples;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      samples.push_back(
          make_camera_sample({{number % width_, number / width_}, i}, options, camera_, filter));
      samples.back().camera_ray.cone.width /= kDetail;
      samples.back().camera_ray.cone.spread /= kDetail;
    }
    std::vector<SampleResult> light(kSamples), glow(kSamples);
    std::vector<FirstHit> hits(kSamples);
    PathIntegrator::Scratch scratch;
    RayCounts rays;
    lit_.trace(samples, light, hits, rays, scratch);
    glow_.trace(samples, glow, {}, rays, scratch);
    Place place;
    for (std::size_t i = 0; i < kSamples; ++i) {
      if (!light[i].radiance.isFinite().all()) continue;
      place.radiance += light[i].radiance / kSamples;
      place.hit[i] = hits[i].hit;
      place.light[i] = luminance(light[i].radiance);
      place.glow[i] = luminance(glow[i].radiance);
      place.albedo[i] = luminance(hits[i].albedo);
    }
    return place;
  }

 private:
  Camera camera_;
  int width_;
  PathIntegrator lit_, glow_;
};

float exposure_of(const std::vector<Place>& places) {
  Picture picture;
  Layer& beauty = picture.layers.emplace_back();
  beauty.channels = {"R", "G", "B"};
  for (const Place& place : places)
    beauty.values.insert(beauty.values.end(), place.radiance.begin(), place.radiance.end());
  return exposure_scale(auto_exposure(picture));
}

}  // namespace

double dark_share(const World& world, const View& view, const Camera& camera, double aspect) {
  const int width = std::clamp(static_cast<int>(std::lround(std::sqrt(kPlaces * aspect))), 1, kPlaces);
  const int height = kPlaces / width;
  const Eye eye(world, view, camera, width, height);
  std::vector<Place> places(static_cast<std::size_t>(width * height));
  for_each(places.size(), [&](std::size_t i) { places[i] = eye.look(static_cast<int>(i)); });
  const float exposure = exposure_of(places);
  double dark = 0.0, all = 0.0;
  for (const Place& place : places) {
    double light = 0.0;
    int matte = 0;  // samples that meet a surface without glow
    for (std::size_t i = 0; i < kSamples; ++i) {
      // A white surface in the soft sky has a radiance of 1. Fainter glows only lift shadows, as those of
      // toon materials: what such a surface receives counts.
      const bool faint = place.glow[i] < kFaint * place.albedo[i];
      if (!place.hit[i] || (place.glow[i] * exposure >= kBlack && !faint)) continue;
      light += static_cast<double>(std::max(place.light[i] - place.glow[i], 0.0f));
      ++matte;
    }
    all += matte;
    if (light * static_cast<double>(exposure) < static_cast<double>(kBlack) * matte) dark += matte;
  }
  return all > 0.0 ? dark / all : 0.0;
}

}  // namespace gatelight::renderer
