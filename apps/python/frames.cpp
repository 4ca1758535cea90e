#include "apps/python/frames.h"

#include <fmt/format.h>

#include <utility>

#include "apps/frame_settings.h"
#include "apps/python/running.h"
#include "apps/python/waiting.h"
#include "apps/terminal/text.h"
#include "base/clock.h"
#include "base/errors.h"
#include "renderer/image/auto_exposure.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::python {

namespace py = pybind11;

Frames::Frames(ScenePointer scene, const py::dict& keywords, py::object progress, py::object stop)
    : scene_(std::move(scene)),
      whole_(settings_for(*scene_, keywords)),
      progress_(std::move(progress)),
      stop_(std::move(stop)) {
  for (const char* flag : {"--checkpoint", "--resume", "--cache-in", "--cache-out"}) {
    if (whole_.given.contains(flag))
      throw BadOption(fmt::format("{}: frames have none here, expected it in `gatelight render`", flag));
  }
  if (!whole_.frames.range) throw BadOption("--frames is missing, expected frames or turntable");
  if (scene_->file && !scene_->loading.load.time && whole_.frames.turntable == 0)
    throw BadOption("--frames: the scene was loaded without a time, expected gatelight.load(path, time=0)");
  frames_ = whole_.frames.range->numbers();
}

void Frames::show(int frame) {
  if (scene_->file && scene_->loading.load.time) {
    const std::lock_guard lock(scene_->file_mutex);
    scene_->file->show(shown_, whole_.frames.seconds(frame));
  }
  renderer_->scene_moved(apps::camera_of_frame(whole_, frame));
}

void Frames::begin(Unfinished unfinished) {
  shown_ = finish_scene(*scene_, std::move(unfinished));
  if (scene_->file && scene_->loading.load.time) {
    const std::lock_guard lock(scene_->file_mutex);
    scene_->file->show(shown_, whole_.frames.seconds(frames_.front()));
  }
  const apps::RenderSettings first = apps::settings_of_frame(whole_, frames_.front());
  renderer_ = std::make_unique<renderer::Renderer>(shown_, first.render);
  if (whole_.render.choose_integrator) renderer::use_integrator(whole_.render, renderer_->integrator());
  if (renderer::uses_cache(renderer_->integrator()) && frames_.size() > 1) {
    for (const int frame : apps::scouted_frames(frames_)) {
      show(frame);
      renderer_->scout();
    }
    show(frames_.front());
  }
  renderer_->begin_frames(whole_.frames.seconds(frames_.front()));
}

PicturePointer Frames::next() {
  if (next_ >= frames_.size()) throw py::stop_iteration();
  const int frame = frames_[next_];
  Unfinished unfinished;
  const bool first = !renderer_;
  if (first) unfinished = copy_of(*scene_);
  PicturePointer picture;
  Waiting waiting(progress_, stop_);
  waiting.run([&] {
    const Clock::time_point start = Clock::now();
    if (first) begin(std::move(unfinished));
    show(frame);
    renderer::Picture made = renderer_->render_frame(frame, waiting.callbacks());
    if (waiting.stopped()) return;  // an unfinished frame would look like a finished one
    apps::RunReport report;
    report.command = {"gatelight.frames"};
    report.load_seconds = scene_->load_seconds;
    report.total_seconds = seconds_since(start);
    for (const std::string& warning : shown_.warnings) report.warnings.push_back(apps::with_flags(warning));
    const float suitable = renderer::auto_exposure(made);
    const apps::RenderSettings settings = apps::settings_of_frame(whole_, frame);
    picture = finish_picture(std::move(made), renderer_->statistics(), settings, report);
    if (!whole_.exposure) whole_.exposure = suitable;  // frames keep the exposure of the first
  });
  if (!picture) throw py::stop_iteration();
  show_warnings(*picture);
  ++next_;
  return picture;
}

}  // namespace gatelight::python
