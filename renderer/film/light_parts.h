#pragma once
// The parts of the light of a sample that are layers: light groups and render passes. In the passes, light
// that reaches the camera without a scattering event is emission or background. The rest is split by the
// lobes of the first surface that scattered it, and into direct light, which is emitted by what that surface
// sees, and indirect light. Panes that a path passes are no scattering events.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/math.h"
#include "renderer/settings/aovs.h"

namespace gatelight::renderer {

/// How the light of lobes is divided: this share of each channel is diffuse, and the rest of one kind.
struct LobeShare {
  enum class Rest : std::uint8_t { glossy, transmission, volume };

  Color diffuse{0.0f, 0.0f, 0.0f};
  Rest rest = Rest::glossy;
};

/// `part` over `whole`, per channel; 0 where there is no light.
inline Color share_of(const Color& part, const Color& whole) {
  return (whole > 0.0f).select((part / whole).min(1.0f), Color::Zero());
}

/// The parts of samples: of light groups, then of passes.
class LightParts {
 public:
  /// Begins the parts of `samples` samples. `groups`: number of light groups.
  void begin(std::span<const Aov> passes, std::size_t groups, std::size_t samples);
  /// Whether there are passes.
  bool any_passes() const { return !first_scattering_.empty(); }
  /// All parts of the first sample, then those of the next.
  std::span<const Color> values() const { return parts_; }

  void add_to_group(std::size_t sample, std::size_t group, const Color& light) {
    parts_[sample * stride_ + group] += light;
  }
  void add(std::size_t sample, Aov pass, const Color& light);
  /// Light that left the first surface, in these lobes.
  void add(std::size_t sample, const LobeShare& lobes, bool direct, const Color& light);

  /// The first scattering event of a path: the lobes that it followed. The second share is that of reflected
  /// light, where the path follows it only for some of the lobes.
  struct FirstScattering {
    LobeShare emitted;
    LobeShare scattered;
    bool in_medium = false;  ///< it was in a medium, before the first surface
    bool indirect = false;   ///< several events counted as one: no light after them is direct
  };
  FirstScattering& first_scattering(std::size_t sample) { return first_scattering_[sample]; }
  /// The first scattering event is in a medium, in front of the first surface, with `events` there.
  void scatter_in_medium(std::size_t sample, int events) {
    const LobeShare volume{.rest = LobeShare::Rest::volume};
    first_scattering_[sample] = {volume, volume, true, events > 1};
  }
  /// Light that a path found after `events` scattering events, as emission or as background.
  void add_found(std::size_t sample, int events, bool background, const Color& light);
  /// Indirect light of the lobes that the path followed.
  void add_indirect(std::size_t sample, const Color& light) {
    add(sample, first_scattering_[sample].scattered, false, light);
  }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  std::vector<Color> parts_;
  std::vector<FirstScattering> first_scattering_;
  std::size_t stride_ = 0;
  std::array<std::size_t, std::size(kAovs)> place_{};  ///< of each pass in the parts of a sample, or kNone
};

}  // namespace gatelight::renderer
