#pragma once
// Boxes that absorb light and do not refract it, in a sky of radiance 1, and Beer's law for rays through
// them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "renderer/film/camera.h"
#include "renderer/film/camera_choice.h"
#include "renderer/medium/scattering_medium.h"
#include "renderer/render.h"
#include "tests/support/materials.h"
#include "tests/support/scene_builder.h"

namespace gatelight::testing {

class AbsorbingBodies : public SceneBuilder {
 public:
  renderer::RenderOptions options;

  AbsorbingBodies() {
    options.width = 24;
    options.height = 18;
    options.spp = 1;
    options.max_depth = options.min_depth = 100;
    options.filter = renderer::PixelFilter::box;
    options.filter_width = 1e-3f;
    options.environment.constant = Color::Ones();
  }

  /// Smaller ones fill the space that they share with larger ones.
  void add(const Box& box, const Color& absorption) {
    scene::Material m = solid_glass(1.0f);
    m.attenuation_distance = 1.0f;
    m.attenuation_color = (-absorption).exp();
    SceneBuilder::box(material(m), box.min(), box.max());
    scene().instances.back().placement = static_cast<int>(scene().instances.size()) - 1;
    bodies_.emplace_back(box, absorption);
    std::sort(bodies_.begin(), bodies_.end(),
              [](const auto& a, const auto& b) { return a.first.volume() < b.first.volume(); });
  }

  /// Of an endless ray.
  Color transmittance(const Vec3& origin, const Vec3& direction) const {
    std::vector<float> cuts{0.0f};
    for (const auto& [box, absorption] : bodies_) {
      const renderer::Span span = renderer::clip(box, origin, direction, 1e6f);
      cuts.insert(cuts.end(), {span.begin, span.end});
    }
    std::sort(cuts.begin(), cuts.end());
    Color depth = Color::Zero();
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      const Vec3 middle = origin + 0.5f * (cuts[i - 1] + cuts[i]) * direction;
      const auto body = std::find_if(bodies_.begin(), bodies_.end(),
                                     [&](const auto& each) { return each.first.contains(middle); });
      if (body != bodies_.end()) depth += (cuts[i] - cuts[i - 1]) * body->second;
    }
    return (-depth).exp();
  }

  renderer::Picture picture() { return renderer::Renderer(scene(), options).render(); }

  /// Each pixel is the transmittance of the ray through its middle.
  void expect_beers_law(float tolerance = 1e-3f) {
    const renderer::Picture seen = picture();
    const float aspect = static_cast<float>(options.width) / static_cast<float>(options.height);
    const renderer::Camera camera(renderer::choose_camera(scene(), options.camera, aspect), options.width,
                                  options.height);
    for (int y = 0; y < options.height; ++y) {
      for (int x = 0; x < options.width; ++x) {
        const renderer::Ray ray = camera.ray(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f).ray;
        const Color expected = transmittance(ray.origin, ray.direction);
        const float* value = &seen.layers[0].values[static_cast<std::size_t>(3 * (y * options.width + x))];
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(value[c], expected[c], tolerance) << x << ", " << y << ": " << c;
      }
    }
  }

 private:
  std::vector<std::pair<Box, Color>> bodies_;  ///< the smallest first
};

}  // namespace gatelight::testing
