#include "renderer/film/light_parts.h"

namespace gatelight::renderer {

void LightParts::begin(std::span<const Aov> passes, std::size_t groups, std::size_t samples) {
  place_.fill(kNone);
  for (std::size_t i = 0; i < passes.size(); ++i) place_[static_cast<std::size_t>(passes[i])] = groups + i;
  stride_ = groups + passes.size();
  parts_.assign(stride_ * samples, Color::Zero());
  first_scattering_.assign(passes.empty() ? 0 : samples, {});
}

void LightParts::add(std::size_t sample, Aov pass, const Color& light) {
  const std::size_t place = place_[static_cast<std::size_t>(pass)];
  if (place != kNone) parts_[sample * stride_ + place] += light;
}

void LightParts::add(std::size_t sample, const LobeShare& lobes, bool direct, const Color& light) {
  constexpr Aov kDirect[] = {Aov::glossy_direct, Aov::transmission_direct, Aov::volume_direct};
  constexpr Aov kIndirect[] = {Aov::glossy_indirect, Aov::transmission_indirect, Aov::volume_indirect};
  const Color diffuse = lobes.diffuse * light;
  add(sample, direct ? Aov::diffuse_direct : Aov::diffuse_indirect, diffuse);
  add(sample, (direct ? kDirect : kIndirect)[static_cast<std::size_t>(lobes.rest)], light - diffuse);
}

void LightParts::add_found(std::size_t sample, int events, bool background, const Color& light) {
  if (events == 0) return add(sample, background ? Aov::background : Aov::emission, light);
  const FirstScattering& first = first_scattering_[sample];
  if (events == 1 && !first.indirect) return add(sample, first.emitted, true, light);
  add(sample, first.scattered, false, light);
}

}  // namespace gatelight::renderer
