#pragma once
// How far light that is carried to the pixels of a frame agrees with the frame's own samples.

#include <vector>

#include "base/math.h"
#include "renderer/image/pixel_rect.h"

namespace gatelight::renderer {

/// What a pixel may take over.
struct ReprojectedSample {
  Color color{0.0f, 0.0f, 0.0f};
  float samples = 0.0f;           ///< 0: nothing
  Color probe{0.0f, 0.0f, 0.0f};  ///< of the place from which it comes
};

/// The samples of a frame, by pixel, in rows from the top.
struct FrameSamples {
  PixelRect rect;
  std::vector<float> color;     ///< 3 floats: their mean
  std::vector<float> albedo;    ///< 3 floats
  std::vector<float> count;     ///< 1 float
  std::vector<float> variance;  ///< 1 float: of the mean of light_of()
};

/// Light that a frame takes over.
struct CarriedLight {
  std::vector<float> color;    ///< 3 floats a pixel; empty: there is none
  std::vector<float> weight;   ///< 1 float a pixel: its share in the mean with the frame's samples
  std::vector<float> samples;  ///< 1 float a pixel: their number together; 0 near edges
  double share = 0.0;          ///< of the pixels that take samples over
};

/// Most samples that a pixel takes over, in those that the frame itself has: more hold light longer still,
/// but follow its changes later.
inline constexpr float kMaxEarlier = 12.0f;

/// The carried light is mixed in by its full share in means over so many pixels around, in each direction.
inline constexpr int kAroundLow = 4;
/// Most change of these means.
inline constexpr float kMaxRatio = 2.0f;

/// Luminance of the light on a surface, without the surface's colour.
float light_of(const float* color, const float* albedo);
/// What a colour is divided by for light_of(), of one channel of the albedo.
float light_divisor(float albedo);

/// A change of light by this share counts as none, where probes notice those of light and shadow.
inline constexpr float kAllowedChange = 0.05f;

/// Takes less over where the light around has changed by more than its noise and `allowed_share`. All work
/// in the caller's arena.
void compare_samples(const FrameSamples& frame, std::vector<ReprojectedSample>& carried,
                     float allowed_share = kAllowedChange);

/// Corrects the carried light by the mean ratio of the samples to it, as far as their noise lets it be known:
/// what a rough surface reflects changes slowly with the view.
void match_brightness(const FrameSamples& frame, std::vector<ReprojectedSample>& carried);

/// `carried`: of all pixels. `edges`: above 0 where nothing is carried on from.
CarriedLight with_carried(const FrameSamples& frame, const std::vector<ReprojectedSample>& carried,
                          const std::vector<float>& edges);

/// Mixes the carried light into a denoised frame: 3 floats for each pixel of `rect`. Means over some pixels
/// take it by its weight; what is finer stays mostly that of the frame, because each time it is carried it is
/// interpolated.
void mix_light(const CarriedLight& carried, const PixelRect& rect, std::vector<float>& denoised);

}  // namespace gatelight::renderer
