#include "apps/python/frames.h"

#include <fmt/format.h>

#include <utility>

#include "apps/film_exposure.h"
#include "apps/film_sky.h"
#include "apps/frame_settings.h"
#include "apps/python/running.h"
#include "apps/terminal/text.h"
#include "base/clock.h"
#include "base/errors.h"
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

void Frames::show_scene(int frame) {
  if (!scene_->file || !scene_->loading.load.time) return;
  const std::lock_guard lock(scene_->file_mutex);
  scene_->file->show(shown_, whole_.frames.seconds(frame));
}

void Frames::show(int frame) {
  show_scene(frame);
  renderer_->scene_moved(apps::camera_of_frame(whole_, frame));
}

void Frames::begin(Unfinished unfinished, Waiting& waiting) {
  shown_ = finish_scene(*scene_, std::move(unfinished));
  show_scene(0);
  const renderer::RenderOptions options = apps::settings_of_frame(whole_, 0).render;
  const bool measured = !whole_.exposure;
  renderer_ =
      std::make_unique<renderer::Renderer>(shown_, measured ? apps::measuring_options(options) : options);
  const auto show_one = [this](int frame) { show(frame); };
  const std::vector<int> frames = apps::sampled_frames({{{0, apps::last_frame_of_film(whole_, shown_)}}});
  apps::choose_sky_of_film(*renderer_, frames, show_one);
  if (measured) {
    whole_.exposure = apps::film_exposure(*renderer_, frames, show_one, {.stop = waiting.callbacks().stop});
    if (waiting.stopped()) whole_.exposure.reset();
    renderer_->set_options(options);
  }
  show(0);
  if (whole_.render.choose_integrator) renderer::use_integrator(whole_.render, renderer_->integrator());
  if (renderer::uses_cache(renderer_->integrator()) && frames_.size() > 1) {
    for (const int frame : apps::sampled_frames(*whole_.frames.range)) {
      show(frame);
      renderer_->scout();
    }
  }
  show(frames_.front());
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
    if (first) begin(std::move(unfinished), waiting);
    if (first && waiting.stopped()) return renderer_.reset();
    for (const int other : apps::frames_of_motion(whole_, frame)) {
      if (renderer_->knows_frame(other)) continue;
      show_scene(other);
      renderer_->note_frame(other, apps::camera_of_frame(whole_, other));
    }
    show(frame);
    renderer::Picture made = renderer_->render_frame(frame, waiting.callbacks());
    if (waiting.stopped()) return;  // an unfinished frame would look like a finished one
    apps::RunReport report;
    report.command = {"gatelight.frames"};
    report.load_seconds = scene_->load_seconds;
    report.total_seconds = seconds_since(start);
    for (const std::string& warning : shown_.warnings) report.warnings.push_back(apps::with_flags(warning));
    for (const std::string& output : whole_.outputs) apps::make_folders_of_frame(output, frame);
    const apps::RenderSettings settings = apps::settings_of_frame(whole_, frame);
    picture = finish_picture(std::move(made), renderer_->statistics(), settings, report);
  });
  if (!picture) throw py::stop_iteration();
  show_warnings(*picture);
  ++next_;
  return picture;
}

}  // namespace gatelight::python
