#pragma once
// The frames of an animation, one after the other.

#include <pybind11/pybind11.h>

#include <memory>
#include <vector>

#include "apps/job/frame_sequence.h"
#include "apps/python/picture_data.h"
#include "apps/python/scene_data.h"
#include "apps/python/waiting.h"

namespace gatelight::python {

class Frames {
 public:
  /// Throws BadOption without frames among the options, and for a scene that shows one time only.
  Frames(ScenePointer scene, const pybind11::dict& keywords, pybind11::object progress,
         pybind11::object stop);

  /// The next picture. Throws pybind11::stop_iteration after the last one, or where `stop` returned true.
  PicturePointer next();
  std::size_t size() const { return frames_.size(); }

 private:
  void begin(SceneContent copy, Waiting& waiting);
  /// The next picture, without the interpreter's lock. Null where `stop` returned true.
  PicturePointer make(int frame, Waiting& waiting);

  ScenePointer scene_;
  apps::RenderSettings settings_;
  std::vector<int> frames_;
  std::size_t next_ = 0;
  scene::Scene shown_;  ///< outlives sequence_
  std::unique_ptr<apps::FrameSequence> sequence_;
  pybind11::object progress_;
  pybind11::object stop_;
};

}  // namespace gatelight::python
