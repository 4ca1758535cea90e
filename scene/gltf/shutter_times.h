#pragma once
// When the states of an open shutter are taken.

#include <vector>

#include "scene/gltf/animation.h"
#include "scene/gltf/motion.h"

namespace gatelight::scene::gltf {

/// A shutter is divided into intervals: evenly, and where an animated value bends or jumps. A jump is an
/// interval of no time. Both halves have equally many, so the middle state is that of the shutter's middle.
class ShutterTimes {
 public:
  struct Moment {
    double seconds;
    bool before;  ///< just before the keys at this time
  };

  /// A shutter that is open for `length` seconds around `middle`.
  ShutterTimes(const Animator& animator, double middle, double length, Warnings& warnings);

  int intervals() const { return static_cast<int>(moments_.size()) - 1; }
  /// Of state k, where each interval is divided into `parts`.
  Moment moment(int k, int parts) const;
  /// ShutterMotion::clock.
  const std::vector<float>& clock() const { return clock_; }

  /// Sets NodeMotion::turn.
  void note_turns(const Animator& animator, Motion& motion, Warnings& warnings) const;

 private:
  struct Point;

  void divide(const std::vector<Point>& points, int least);

  std::vector<Moment> moments_;  ///< of the ends of the intervals
  std::vector<float> clock_;
};

}  // namespace gatelight::scene::gltf
