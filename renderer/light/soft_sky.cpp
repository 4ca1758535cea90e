#include "renderer/light/soft_sky.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace gatelight::renderer {

bool reflects(const scene::Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(),
                     [&](const scene::Instance& instance) { return !scene.material_of(instance).unlit; });
}

bool glows(const scene::Scene& scene) {
  return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const scene::Instance& instance) {
    return scene.material_of(instance).emits() && !scene.mesh_of(instance).triangles.empty();
  });
}

EnvironmentPicture make_soft_sky(float scale) {
  constexpr int kWidth = 256, kHeight = 128;
  const Color zenith(0.30f, 0.36f, 0.44f), horizon(0.48f, 0.48f, 0.48f), ground(0.15f, 0.14f, 0.13f);
  const Color lamp(5.5f, 5.3f, 5.0f);
  const Vec3 towards_lamp = Vec3(-0.5f, 0.75f, 0.6f).normalized();
  std::vector<Color> texels;
  texels.reserve(std::size_t{kWidth} * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float theta = kPi * (static_cast<float>(y) + 0.5f) / kHeight;
      const float phi = 2.0f * kPi * ((static_cast<float>(x) + 0.5f) / kWidth - 0.5f);
      const Vec3 d(std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi));
      // The ground blends into the sky within some degrees.
      const float above = std::clamp(0.5f + 4.0f * d.y(), 0.0f, 1.0f);
      const Color sky = horizon + (zenith - horizon) * std::sqrt(std::max(0.0f, d.y()));
      const Color light = lamp * std::exp(-12.0f * (1.0f - d.dot(towards_lamp)));
      texels.emplace_back((ground + (sky - ground) * above + light) * scale);
    }
  }
  return {kWidth, kHeight, std::move(texels)};
}

}  // namespace gatelight::renderer
