#pragma once
// Pictures of scenes at the extremes, and checks of them.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/render.h"
#include "renderer/settings/enum_names.h"
#include "scene/bake.h"
#include "tests/support/room.h"
#include "tests/support/scene_builder.h"

namespace gatelight::testing {

struct Rendered {
  std::vector<float> values;  ///< R, G, B of each pixel
  renderer::RenderStatistics statistics;

  double mean() const {
    double sum = 0.0;
    for (const float v : values) sum += static_cast<double>(v);
    return sum / static_cast<double>(values.size());
  }
};

inline constexpr renderer::Integrator kAll[] = {renderer::Integrator::path, renderer::Integrator::ao,
                                                renderer::Integrator::nrc, renderer::Integrator::nao};

inline renderer::RenderOptions room_picture(renderer::Integrator integrator, int train_steps) {
  renderer::RenderOptions options = small_picture();
  options.aovs.clear();
  options.width = 64;
  options.height = 48;
  options.integrator = integrator;
  options.spp = 8;
  options.cache.train_steps = train_steps;
  options.cache.batch = 1024;
  return options;
}

/// Options for a picture of an object at the origin, about a metre large, under a sky of radiance 1.
inline renderer::RenderOptions white_sky(int spp, int depth) {
  renderer::RenderOptions options;
  options.width = options.height = 16;
  options.spp = spp;
  options.max_depth = depth;
  options.environment.constant = Color::Ones();
  options.filter = renderer::PixelFilter::box;
  options.camera.look_at = renderer::LookAt{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}};
  options.camera.fov_degrees = 16.0f;
  return options;
}

/// A picture without non-finite and negative values.
inline Rendered render(const scene::Scene& scene, const renderer::RenderOptions& options) {
  renderer::Renderer renderer(scene, options);
  Rendered result;
  result.values = renderer.render().layers[0].values;
  result.statistics = renderer.statistics();
  EXPECT_EQ(result.statistics.nonfinite, 0u);
  for (const float v : result.values) EXPECT_TRUE(std::isfinite(v) && v >= 0.0f) << v;
  return result;
}

/// Mean over blocks of pixels of the squared difference over the squared value: noise of single pixels counts
/// little, a shift of light much.
inline double block_error(const Rendered& a, const Rendered& b, int width, int block = 8) {
  const int height = static_cast<int>(a.values.size()) / 3 / width;
  double sum = 0.0;
  int blocks = 0;
  for (int y0 = 0; y0 + block <= height; y0 += block) {
    for (int x0 = 0; x0 + block <= width; x0 += block) {
      double mean_a = 0.0, mean_b = 0.0;
      for (int y = y0; y < y0 + block; ++y) {
        for (int i = 3 * x0; i < 3 * (x0 + block); ++i) {
          const auto at = static_cast<std::size_t>(3 * y * width + i);
          mean_a += static_cast<double>(a.values[at]);
          mean_b += static_cast<double>(b.values[at]);
        }
      }
      const double d = mean_a - mean_b;
      sum += d * d / (mean_a * mean_a + mean_b * mean_b + 1e-12);
      ++blocks;
    }
  }
  return sum / blocks;
}

/// Scales all vertices, cameras and lights of a scene whose instances are baked about the origin, then moves
/// them. The radiance of lamps does not change.
inline void resize(scene::Scene& scene, float scale, const Vec3& shift = Vec3::Zero()) {
  for (scene::Mesh& mesh : scene.meshes) {
    for (Vec3& p : mesh.positions) p = p * scale + shift;
  }
  for (scene::Camera& camera : scene.cameras) {
    camera.transform.translation() = camera.transform.translation() * scale + shift;
  }
  for (scene::PunctualLight& light : scene.lights) {
    light.position = light.position * scale + shift;
    if (light.type != scene::LightType::directional) light.intensity *= scale * scale;
    light.range *= scale;
  }
  scene.bounds = scene::compute_bounds(scene);
}

inline void resize(renderer::RenderOptions& options, float scale, const Vec3& shift = Vec3::Zero()) {
  if (!options.camera.look_at) return;
  options.camera.look_at->eye = options.camera.look_at->eye * scale + shift;
  options.camera.look_at->target = options.camera.look_at->target * scale + shift;
}

}  // namespace gatelight::testing
