#pragma once
// How the time of a picture is divided. Plain arithmetic: the caller measures.

#include <algorithm>
#include <limits>

namespace gatelight::renderer {

/// Seconds since the picture was begun: scouting, setup, training, passes, and denoising last.
struct TimeBudget {
  double limit = 0.0;    ///< 0: none
  double denoise = 0.0;  ///< expected, and reserved
  double shadows = 0.0;  ///< the same, for the catchers of shadows

  /// When the passes should end; infinity without a limit.
  double passes_end() const {
    if (limit <= 0.0) return std::numeric_limits<double>::infinity();
    return std::max(limit - denoise - shadows, 0.0);
  }
  /// When training should end that begins at `now`; the passes have what is left. teaching_samples: the paths
  /// of training are samples of the picture, so that its time is not lost.
  double training_end(double now, bool teaching_samples) const;
};

/// Training goes on with a group of steps only where it is expected to end in time.
inline bool group_fits(double now, double seconds, double end) {
  return now + seconds <= end;
}

/// A pass begins where it is nearer to the end with it than without it.
inline bool pass_fits(double now, double seconds, double end) {
  return now + 0.5 * seconds <= end;
}

/// Samples of each pixel in the next pass, at most `most`: as many as take `usual` seconds, or fit before the
/// end. At least one.
int samples_of_pass(double now, double seconds_per_sample, double usual, double end, int most);

}  // namespace gatelight::renderer
