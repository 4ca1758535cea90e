#pragma once
// The temporal deviation: how much more or less a sequence of pictures changes from frame to frame than its
// reference does. Flicker and boiling noise raise it; motion in both does not.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "renderer/image/tonemap.h"
#include "renderer/metrics/beauty.h"

namespace gatelight::renderer {

struct TemporalOptions {
  // How radiance is converted for the screen, as for ldr_flip().
  float exposure = 0.0f;  ///< stops
  Tonemap tonemap = Tonemap::none;
};

/// The standard deviation in pixels of the Gaussian that separates low from high frequencies. Its weights end
/// at three standard deviations; beyond the edges of the picture the pixels there are repeated.
inline constexpr double kTemporalSigma = 6.0;

/// Root mean squares over pixels, channels and pairs of consecutive frames, in values of the screen, whose
/// white is 1.
struct TemporalDeviation {
  double low = 0.0;   ///< of the deviation after the Gaussian: areas that flicker
  double high = 0.0;  ///< of the rest: noise and edges that flicker
};

/// Takes the frames of both sequences one at a time and in order. The deviation of a pair of frames is
/// (test_n - test_(n-1)) - (reference_n - reference_(n-1)), for red, green and blue on the screen: sRGB in
/// [0, 1], not rounded to bytes. Equal sequences give exactly 0. Gives the same bits for any number of
/// threads.
class TemporalMeter {
 public:
  explicit TemporalMeter(const TemporalOptions& options = {}) : options_(options) {}

  /// Adds the next frame. The pictures are not needed afterwards: a difference of three floats per pixel is
  /// kept. Throws what require_comparable() throws, also for a frame that is not comparable with the first
  /// one, and InputError for pictures without pixels or with values that are not finite. A frame that is
  /// refused is not added.
  void add(const NamedPicture& reference, const NamedPicture& test);

  /// The deviation of all frames so far; none before the second.
  std::optional<TemporalDeviation> deviation() const;

 private:
  /// `now`: the differences of the next frame, which has rows of `width` pixels.
  void add_pair(const std::vector<float>& now, std::size_t width);

  TemporalOptions options_;
  Picture first_;  ///< the first reference, without its values
  std::string first_name_;
  std::vector<float> before_;  ///< test minus reference of the last frame: the red rows, the green, the blue
  double low_ = 0.0;           ///< sum of squares
  double high_ = 0.0;
  std::uint64_t values_ = 0;  ///< number of squares in each sum
};

}  // namespace gatelight::renderer
