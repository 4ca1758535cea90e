#include "renderer/surface/media.h"

#include <algorithm>

namespace gatelight::renderer {

void MediumStack::enter(std::uint32_t volume) {
  const auto begin = volumes_.begin(), end = begin + count_;
  const auto at = std::lower_bound(begin, end, volume);
  if (at == volumes_.end() || (at != end && *at == volume)) return;
  if (count_ < kMax) ++count_;
  std::copy_backward(at, begin + count_ - 1, begin + count_);
  *at = volume;
}

void MediumStack::leave(std::uint32_t volume) {
  const auto begin = volumes_.begin(), end = begin + count_;
  const auto at = std::lower_bound(begin, end, volume);
  if (at == end || *at != volume) return;
  std::copy(at + 1, end, at);
  --count_;
}

Color absorption_of(const scene::Material& m) {
  if (!m.has_volume() || !(m.attenuation_distance < kInfinity)) return Color::Zero();
  // Finite, so that no distance makes it NaN.
  return (-m.attenuation_color.max(1e-30f).log() / m.attenuation_distance).min(1e30f);
}

Media::Media(const scene::Scene& scene, bool needed) {
  if (!needed) return;
  scene::NestedVolumes nested = scene::find_nested_volumes(scene);
  of_instance_ = std::move(nested.of_instance);
  for (const std::uint32_t instance : nested.instances) {
    const scene::Material& m = scene.material_of(scene.instances[instance]);
    media_.push_back({m.ior > 0.0f ? m.ior : 1.0f, m.dispersion, absorption_of(m)});
  }
}

bool make_index_matched(SurfaceMaterial& material, float u) {
  const float glass = glass_share(material);
  if (u < glass) {
    material = {.roughness = 0.0f, .ior = 1.0f, .specular = 0.0f, .transmission = 1.0f};
    return true;
  }
  material.metallic /= 1.0f - glass;
  material.transmission = 0.0f;
  return false;
}

}  // namespace gatelight::renderer
