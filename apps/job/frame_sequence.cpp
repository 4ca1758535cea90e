#include "apps/job/frame_sequence.h"

#include <utility>

#include "apps/job/frame_settings.h"
#include "apps/job/sequence_exposure.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::apps {

FrameSequence::FrameSequence(const RenderSettings& settings, const scene::Scene& scene, ShowTime show_time,
                             bool displayed)
    : settings_(settings),
      show_time_(std::move(show_time)),
      needs_exposure_(displayed && !settings.exposure),
      sample_(sampled_frames(last_frame_of_animation(settings, scene))),
      renderer_(build(scene)) {
  shown_ = 0;
  choose_sky();
  move_to(0);
  if (!needs_exposure_) keep_choices();
}

renderer::Renderer FrameSequence::build(const scene::Scene& scene) {
  show_time(0);
  const renderer::RenderOptions options = settings_of_frame(settings_, 0).render;
  return {scene, needs_exposure_ ? measuring_options(options) : options};
}

/// No sky where what glows shows the surfaces in one of the frames.
void FrameSequence::choose_sky() {
  if (!renderer_.soft_sky()) return;
  renderer_.keep_soft_sky({});
  bool sky = true;
  for (const int frame : sample_) {
    move_to(frame);
    sky = renderer_.soft_sky().value_or(true);
    if (!sky) break;
  }
  renderer_.keep_soft_sky(sky);
}

void FrameSequence::measure_exposure(const std::function<bool()>& stop) {
  const renderer::RenderOptions options = settings_of_frame(settings_, 0).render;
  settings_.exposure =
      sequence_exposure(renderer_, sample_, [this](int frame) { move_to(frame); }, {.stop = stop});
  renderer_.set_options(options);
  move_to(0);
  needs_exposure_ = false;
  keep_choices();
}

/// Frame 0 is shown, with the options of the frames.
void FrameSequence::keep_choices() {
  renderer::use_chosen(settings_.render, renderer_.chosen());
}

void FrameSequence::begin() {
  int first = 0;
  if (renderer::uses_cache(renderer_.chosen().integrator)) {
    const FrameList& frames = *settings_.frames.range;
    first = frames.first();
    for (const int frame : frames.is_single() ? std::vector<int>{} : sampled_frames(frames.numbers())) {
      move_to(frame);
      renderer_.scout();
    }
  }
  move_to(first);
  renderer_.begin_frames(settings_.frames.seconds(first));
}

std::optional<int> FrameSequence::begin_from(const std::string& file) {
  const renderer::FrameStatus status = renderer::read_frame_status(file);
  shown_.reset();
  show_time_(status.layout_seconds);
  renderer_.scene_moved(camera_of_frame(settings_, status.frame.value_or(settings_.frames.range->first())));
  renderer_.begin_frames(status.layout_seconds, file);
  if (!status.frame) return {};
  move_to(*status.frame);
  renderer_.restore_frame(file);
  return status.frame;
}

void FrameSequence::show_time(int frame) {
  shown_.reset();
  show_time_(settings_.frames.seconds(frame));
}

void FrameSequence::move_to(int frame) {
  if (shown_ == frame) return;
  show_time(frame);
  renderer_.scene_moved(camera_of_frame(settings_, frame));
  shown_ = frame;
}

void FrameSequence::show(int frame) {
  for (const int other : frames_of_motion(settings_, frame)) {
    if (renderer_.knows_frame(other)) continue;
    show_time(other);
    renderer_.note_frame(other, camera_of_frame(settings_, other));
  }
  move_to(frame);
}

renderer::Picture FrameSequence::render(int frame, const renderer::Callbacks& callbacks) {
  show(frame);
  return renderer_.render_frame(frame, callbacks);
}

}  // namespace gatelight::apps
