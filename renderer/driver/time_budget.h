#pragma once
// How the time of a picture is divided. Plain arithmetic: the caller measures.

#include <algorithm>
#include <limits>

namespace gatelight::renderer {

/// Seconds since the picture was begun: scouting, setup, training, passes, and denoising last.
struct TimeBudget {
  double limit = 0.0;   ///< 0: none
  double finish = 0.0;  ///< expected time of shadow catchers and denoising, which is reserved

  /// When the passes should end; infinity without a limit.
  double passes_end() const {
    if (limit <= 0.0) return std::numeric_limits<double>::infinity();
    return std::max(limit - finish, 0.0);
  }
  /// The time at which training that begins at `now` should end; the passes have the rest.
  /// training_paths_are_samples: the paths of training are samples of the picture, so that its time is not
  /// lost.
  double training_end(double now, bool training_paths_are_samples) const;
};

/// Training goes on with a group of steps only where it is expected to end in time.
inline bool group_fits(double now, double seconds, double end) {
  return now + seconds <= end;
}

/// A pass begins where it is nearer to the end with it than without it.
inline bool pass_fits(double now, double seconds, double end) {
  return now + 0.5 * seconds <= end;
}

/// Number of samples of each pixel in the next pass, from 1 to `most`: those that take `usual` seconds, or
/// fit before the end.
int samples_of_pass(double now, double seconds_per_sample, double usual, double end, int most);

}  // namespace gatelight::renderer
