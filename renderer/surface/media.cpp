#include "renderer/surface/media.h"

#include <fmt/format.h>

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

Color extinction_of(const scene::Material& m) {
  if (!m.has_volume() || !(m.attenuation_distance < kInfinity)) return Color::Zero();
  // Finite, so that no distance makes it NaN.
  return (-m.attenuation_color.max(1e-30f).log() / m.attenuation_distance).min(1e30f);
}

Media::Media(const scene::Scene& scene, bool nested_volumes, bool unrefracted_glass,
             const std::optional<ScatteringMedium>& fog)
    : fog_(fog) {
  for (const scene::Material& m : scene.materials) {
    insides_.push_back({.extinction = extinction_of(m),
                        .albedo = m.scatters()
                                      ? single_scattering_albedo(m.multiscatter_color, m.scatter_anisotropy)
                                      : Color(Color::Zero()),
                        .anisotropy = m.scatter_anisotropy,
                        .color = m.multiscatter_color,
                        .sampled = unrefracted_glass && m.transmission > 0.0f});
    ScatteringMedium& medium = insides_.back();
    medium.scatters = (medium.albedo * medium.extinction > 0.0f).any();
  }
  // Light might never leave a body with a hole: it only absorbs.
  if (std::any_of(scene.materials.begin(), scene.materials.end(),
                  [](const auto& m) { return m.scatters(); })) {
    std::string names;
    for (const int material : scene::open_scatterers(scene)) {
      insides_[static_cast<std::size_t>(material)].scatters = false;
      names += (names.empty() ? "'" : ", '") + scene.materials[static_cast<std::size_t>(material)].name + "'";
    }
    if (!names.empty())
      warning_ = fmt::format("{}: bodies of {} have holes: they absorb light and do not scatter it",
                             scene.path, names);
  }
  if (fog_) air_.inside = &*fog_;
  if (!nested_volumes && !air_.inside) return;
  // Fog needs to know where it is not: inside all bodies.
  scene::NestedVolumes nested = scene::find_nested_volumes(scene, air_.inside != nullptr);
  of_instance_ = std::move(nested.of_instance);
  for (const std::uint32_t instance : nested.instances) {
    const scene::Material& m = scene.material_of(scene.instances[instance]);
    const int material = scene.mesh_of(scene.instances[instance]).material;
    media_.push_back({m.ior > 0.0f ? m.ior : 1.0f, m.dispersion, inside(material), instance});
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
