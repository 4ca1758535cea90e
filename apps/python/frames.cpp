// The frames of an animation, one after the other.

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <utility>
#include <vector>

#include "apps/job/frame_sequence.h"
#include "apps/job/frame_settings.h"
#include "apps/python/keywords.h"
#include "apps/python/module.h"
#include "apps/python/picture_data.h"
#include "apps/python/running.h"
#include "apps/python/scene_data.h"
#include "apps/python/waiting.h"
#include "base/clock.h"
#include "base/errors.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

class Frames {
 public:
  /// Throws BadOption without frames among the options, and for a scene that shows one time only.
  Frames(ScenePointer scene, const py::dict& keywords, py::object progress, py::object stop);

  /// The next picture. Throws py::stop_iteration after the last one, or where `stop` returned true.
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
  py::object progress_;
  py::object stop_;
};

Frames::Frames(ScenePointer scene, const py::dict& keywords, py::object progress, py::object stop)
    : scene_(std::move(scene)),
      settings_(settings_for(*scene_, keywords)),
      progress_(std::move(progress)),
      stop_(std::move(stop)) {
  require_given(
      settings_, [](const apps::Option& option) { return option.group != "Files"; },
      "is not available for frames in Python", "`gatelight render` for it");
  if (!settings_.frames.range) throw BadOption({"frames", "", "it is missing", "frames or turntable"});
  if (scene_->file && !scene_->loading.load.time && settings_.frames.turntable == 0)
    throw BadOption({"frames", "", "the scene was loaded without a time", "gatelight.load(path, time=0)"});
  frames_ = settings_.frames.range->numbers();
}

void Frames::begin(SceneContent copy, Waiting& waiting) {
  shown_ = finish_scene(*scene_, std::move(copy));
  const auto show_time = [this](double seconds) {
    if (!scene_->file || !scene_->loading.load.time) return;
    const std::lock_guard lock(scene_->file_mutex);
    scene_->file->show(shown_, seconds);
  };
  sequence_ = std::make_unique<apps::FrameSequence>(settings_, shown_, show_time, true);
  if (sequence_->needs_exposure()) sequence_->measure_exposure(waiting.callbacks().stop);
  if (!waiting.stopped()) sequence_->begin();
}

PicturePointer Frames::make(int frame, Waiting& waiting) {
  const Clock::time_point start = Clock::now();
  renderer::Picture made = sequence_->render(frame, waiting.callbacks());
  if (waiting.stopped()) return nullptr;  // an unfinished frame would look like a finished one
  apps::RunReport report;
  report.command = {"gatelight.frames"};
  report.load_seconds = scene_->load_seconds;
  report.total_seconds = seconds_since(start);
  report.warnings = shown_.warnings;
  const apps::RenderSettings& all = sequence_->settings();
  for (const std::string& output : all.outputs) apps::make_folders_of_frame(output, frame);
  return finish_picture(std::move(made), sequence_->renderer().statistics(),
                        apps::settings_of_frame(all, frame), report);
}

PicturePointer Frames::next() {
  if (next_ >= frames_.size()) throw py::stop_iteration();
  SceneContent copy;
  const bool first = !sequence_;
  if (first) copy = *scene_;
  PicturePointer picture;
  Waiting waiting(progress_, stop_);
  waiting.run([&] {
    if (first) begin(std::move(copy), waiting);
    if (first && waiting.stopped()) return sequence_.reset();
    picture = make(frames_[next_], waiting);
  });
  if (!picture) throw py::stop_iteration();
  show_warnings(*picture);
  ++next_;
  return picture;
}

}  // namespace

void add_frames(py::module_& module) {
  py::class_<Frames> frames(module, "Frames", "An iterator over the frames of an animation.");
  frames.def(py::init([](const ScenePointer& scene, const py::dict& options, const py::object& progress,
                         const py::object& stop) {
               return std::make_unique<Frames>(scene, options, progress, stop);
             }),
             py::arg("scene"), py::arg("options"), py::arg("progress"), py::arg("stop"));
  frames.def("__iter__", [](py::object self) { return self; });
  frames.def("__next__", &Frames::next);
  frames.def("__len__", &Frames::size);
}

}  // namespace gatelight::python
