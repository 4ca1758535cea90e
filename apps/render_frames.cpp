#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/film_exposure.h"
#include "apps/film_sky.h"
#include "apps/frame_groups.h"
#include "apps/frame_settings.h"
#include "apps/render_run.h"
#include "apps/reports/frame_report.h"
#include "apps/settings/camera_names.h"
#include "apps/settings/frame_flags.h"
#include "apps/settings/picture_output.h"
#include "apps/settings/unused_flags.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/terminal.h"
#include "base/errors.h"
#include "renderer/distributed/collectives.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::apps {
namespace {

std::optional<Failure> described(const std::exception_ptr& error) {
  if (!error) return {};
  try {
    std::rethrow_exception(error);
  } catch (...) {
    return describe_current_exception();
  }
}

}  // namespace

int RenderRun::render_frames(scene::SceneFile& file, scene::Scene& scene) {
  int code = kDone;
  for (const RenderSettings& of_camera : pictures_of(settings_, scene)) {
    whole_ = of_camera;
    const int ended = render_film(file, scene);
    if (ended >= kSignalBase) return ended;
    if (ended != kDone) code = ended;
  }
  if (failed_frame_) std::rethrow_exception(failed_frame_);
  return code;
}

int RenderRun::render_film(scene::SceneFile& file, scene::Scene& scene) {
  const int groups = whole_.frames.groups;
  const std::vector<int> all = whole_.frames.range->numbers();
  const std::set<int> existing = existing_frames(all);
  if (existing.size() == all.size()) {
    end_frames(0, 0.0);
    return kDone;
  }
  progress_.phase("build");
  const Clock::time_point begin = Clock::now();
  const std::string before = state_before();
  renderer::Renderer renderer = make_renderer(file, scene);
  if (whole_.render.choose_integrator) renderer::use_integrator(whole_.render, renderer.integrator());
  check_frame_groups(whole_.frames, renderer.integrator());
  if (before.empty()) note_part(scene, all, existing);
  const std::size_t warnings_of_loading = report_.warnings.size();
  const std::optional<int> done = begin_frames(file, scene, renderer, before);
  std::vector<int> frames(done ? std::find(all.begin(), all.end(), *done) + 1 : all.begin(), all.end());
  std::erase_if(frames, [&](int frame) { return existing.contains(frame); });
  frames = frames_of_group(frames, groups, number_of_group(groups, all_.ranks));
  if (!frames.empty()) last_frame_ = frames.back();
  int number = 0;
  std::size_t i = 0;
  for (; i < frames.size(); ++i) {
    report_.warnings.resize(warnings_of_loading);
    progress_.begin_frame(frames[i], i, frames.size());
    try {
      number = make_frame(file, scene, renderer, frames[i]);
    } catch (const OutOfMemory&) {
      throw;
    } catch (const DeviceLost&) {
      throw;
    } catch (const std::exception&) {
      if (!group_.ranks.is_single()) throw;  // the others wait for this one
      note_failed_frame(frames[i]);
    }
    if (number != 0) break;
  }
  if (groups > 1) return end_groups(number, i, all.size(), seconds_since(begin));
  if (number != 0) return stop_frames(number, i, frames.size());
  end_frames(frames.size(), seconds_since(begin));
  return kDone;
}

renderer::Renderer RenderRun::make_renderer(scene::SceneFile& file, scene::Scene& scene) {
  // What is chosen for the scene is chosen by the film's first frame, whichever of its frames are rendered.
  file.show(scene, whole_.frames.seconds(0));
  shown_frame_.reset();
  settings_ = settings_of_frame(whole_, 0);
  const bool measured = !whole_.exposure && shows_on_a_screen(whole_.outputs);
  renderer::Renderer renderer(scene, measured ? measuring_options(settings_.render) : settings_.render,
                              group_.ranks);
  shown_frame_ = 0;
  const auto show = [&](int frame) { show_frame(file, scene, renderer, frame); };
  const int last = last_frame_of_film(whole_, scene);
  const std::vector<int> frames = sampled_frames({{{0, last}}});
  choose_sky_of_film(renderer, frames, show);
  if (measured) {
    progress_.phase("exposure");
    whole_.exposure = film_exposure(renderer, frames, show, {.stop = [] { return stop_signal() != 0; }});
    note("exposure",
         fmt::format("{:.1f} EV by the light of the film, {} of its frames 0 to {}; --exposure {:.1f} "
                     "keeps it",
                     *whole_.exposure, frames.size(), last, *whole_.exposure));
    settings_ = settings_of_frame(whole_, 0);
    renderer.set_options(settings_.render);
  }
  show(0);
  return renderer;
}

void RenderRun::note_part(const scene::Scene& scene, const std::vector<int>& frames,
                          const std::set<int>& existing) {
  const renderer::RenderOptions& options = whole_.render;
  const bool cached = renderer::uses_cache(options.integrator);
  const bool carried = options.denoise.denoiser != renderer::DenoiserKind::none && options.denoise.temporal;
  const int last = last_frame_of_film(whole_, scene);
  const bool whole = existing.empty() && frames.front() <= 0 && frames.back() >= last - 1 &&
                     (frames.size() < 2 || common_step(frames) == 1);
  if (whole || last == 0 || (!cached && !carried)) return;
  note("part",
       fmt::format(
           "of the film, frames 0 to {}: its frames differ a little from those of a run of all, by {}{}{}; "
           "--integrator path --temporal off keeps them the same",
           last, cached ? "a kept cache" : "", cached && carried ? " and " : "",
           carried ? "carried light" : ""));
}

std::string RenderRun::state_before() {
  const std::string& checkpoint = whole_.render.checkpoint.file;
  const bool resumed = whole_.render.checkpoint.resume && std::filesystem::exists(checkpoint);
  const std::string before = resumed ? checkpoint : whole_.render.cache.cache_in;
  if (!before.empty() && !whole_.exposure) whole_.exposure = renderer::read_frame_status(before).exposure;
  return before;
}

std::set<int> RenderRun::existing_frames(const std::vector<int>& frames) {
  std::set<int> existing;
  if (!whole_.skip_existing) return existing;
  for (const int frame : frames) {
    if (renderer::agreed(all_.ranks, are_there(settings_of_frame(whole_, frame).outputs)))
      existing.insert(frame);
  }
  note_skipped(existing.size(), frames.size());
  return existing;
}

void RenderRun::make_folders(int frame) const {
  if (!group_.ranks.first()) return;
  for (const std::string& output : whole_.outputs) make_folders_of_frame(output, frame);
  for (const std::string& file : {whole_.stats, whole_.render.cache.cache_out})
    make_folders_of_frame(file, frame);
}

void RenderRun::show_frame(scene::SceneFile& file, scene::Scene& scene, renderer::Renderer& renderer,
                           int frame) {
  if (shown_frame_ == frame) return;
  shown_frame_.reset();
  file.show(scene, whole_.frames.seconds(frame));
  renderer.scene_moved(camera_of_frame(whole_, frame));
  shown_frame_ = frame;
}

void RenderRun::show_places(scene::SceneFile& file, scene::Scene& scene, renderer::Renderer& renderer,
                            int frame) {
  if (!group_.ranks.first()) return;  // it makes these layers
  for (const int other : frames_of_motion(whole_, frame)) {
    if (renderer.knows_frame(other)) continue;
    shown_frame_.reset();
    file.show(scene, whole_.frames.seconds(other));
    renderer.note_frame(other, camera_of_frame(whole_, other));
  }
}

std::optional<int> RenderRun::begin_frames(scene::SceneFile& file, scene::Scene& scene,
                                           renderer::Renderer& renderer, const std::string& before) {
  if (!before.empty()) return go_on(file, scene, renderer, before);
  int first = 0;
  if (renderer::uses_cache(renderer.integrator())) {
    const FrameList& frames = *whole_.frames.range;
    first = frames.first();
    for (const int frame : frames.is_single() ? std::vector<int>{} : sampled_frames(frames)) {
      show_frame(file, scene, renderer, frame);
      renderer.scout();
    }
  }
  show_frame(file, scene, renderer, first);
  renderer.begin_frames(whole_.frames.seconds(first));
  return {};
}

std::optional<int> RenderRun::go_on(scene::SceneFile& file, scene::Scene& scene, renderer::Renderer& renderer,
                                    const std::string& before) {
  const renderer::FrameStatus status = renderer::read_frame_status(before);
  if (!status.of_animation && scene.motion.any())
    throw CacheFileError(fmt::format("{}: made of the file's nodes, expected a cache of --frames", before));
  const std::vector<int> frames = whole_.frames.range->numbers();
  file.show(scene, status.layout_seconds);
  renderer.scene_moved(camera_of_frame(whole_, status.frame.value_or(frames.front())));
  shown_frame_.reset();
  renderer.begin_frames(status.layout_seconds, before);
  if (!status.frame) return {};
  show_frame(file, scene, renderer, *status.frame);
  renderer.restore_frame(before);
  if (before != whole_.render.checkpoint.file) return {};
  if (std::find(frames.begin(), frames.end(), *status.frame) == frames.end())
    throw CacheFileError(
        fmt::format("{}: it ends with frame {}, expected one of --frames", before, *status.frame));
  return status.frame;
}

int RenderRun::make_frame(scene::SceneFile& file, scene::Scene& scene, renderer::Renderer& renderer,
                          int frame) {
  start_ = Clock::now();
  make_folders(frame);
  settings_ = settings_of_frame(whole_, frame);
  show_places(file, scene, renderer, frame);
  show_frame(file, scene, renderer, frame);
  for (const std::string& warning : scene.warnings) warn(warning);
  for (const std::string& warning : renderer.statistics().warnings) warn(warning);
  if (const int number = signal(); number != 0) return number;
  renderer::Picture picture = renderer.render_frame(frame, make_callbacks(renderer));
  // An unfinished frame would look like a finished one.
  if (const int number = signal(); number != 0) return number;
  end_picture(std::move(picture), renderer.statistics());
  if (!group_.ranks.first()) return 0;
  write_state(renderer, frame);
  if (!progress_.frame_done(frame, summary_json(settings_, report_)) && !settings_.quiet) {
    progress_.clear();
    print_status(frame_line(frame, settings_, report_));
  }
  return 0;
}

void RenderRun::write_state(const renderer::Renderer& renderer, int frame) {
  const std::string& checkpoint = whole_.render.checkpoint.file;
  const std::string& cache = whole_.render.cache.cache_out;
  if (!checkpoint.empty()) renderer.write_frame(checkpoint, whole_.exposure);
  if (!cache.empty() && (has_frame_place(cache) || frame == last_frame_))
    renderer.write_frame(name_of_frame(cache, frame), whole_.exposure);
}

void RenderRun::note_failed_frame(int frame) {
  if (!failed_frame_) failed_frame_ = std::current_exception();
  warn(fmt::format("frame {} failed: {}", frame, describe_current_exception().message));
}

int RenderRun::stop_frames(int signal, std::size_t done, std::size_t count) {
  progress_.clear();
  print_notice(
      fmt::format("stopped by signal {} after {} of {} frames; the one that was under way is lost{}", signal,
                  done, count, whole_.render.checkpoint.file.empty() ? "" : ", --resume goes on with it"),
      kSignalBase + signal);
  return kSignalBase + signal;
}

int RenderRun::end_groups(int signal, std::size_t done, std::size_t count, double seconds) {
  if (signal != 0) all_.stop_others(signal);
  FrameResults mine;
  // The ranks of a group have the same results, and rank 0 has printed its warnings.
  if (group_.ranks.first()) {
    mine = {.signal = signal, .done = done};
    mine.failure = described(failed_frame_);
    if (!all_.ranks.first()) mine.warnings = {printed_warnings_.begin(), printed_warnings_.end()};
  }
  const FrameResults of_all = joined_results(all_.ranks, mine);
  if (of_all.signal != 0) return stop_frames(of_all.signal, of_all.done, count);
  if (all_.ranks.first()) {
    for (const std::string& warning : of_all.warnings) warn(warning);
    end_frames(count, seconds);
  }
  renderer::agreed(all_.ranks, 0);  // what follows may end all ranks: rank 0 has reported by now
  failed_frame_ = nullptr;          // it is reported here
  if (!of_all.failure) return kDone;
  print_failure(*of_all.failure);
  return of_all.failure->code;
}

void RenderRun::end_frames(std::size_t count, double seconds) {
  if (!group_.ranks.first()) return;
  if (progress_.done({{"frames", count}, {"seconds", seconds}}) || settings_.quiet) return;
  print_status(frames_summary(count, seconds, report_));
}

}  // namespace gatelight::apps
