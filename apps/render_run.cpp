#include "apps/render_run.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/rank_checks.h"
#include "apps/reports/glare_warning.h"
#include "apps/reports/overflow_warning.h"
#include "apps/reports/recipe.h"
#include "apps/settings/camera_names.h"
#include "apps/settings/picture_output.h"
#include "apps/settings/unused_flags.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"
#include "base/errors.h"
#include "renderer/denoise/oidn_library.h"
#include "renderer/distributed/collectives.h"
#include "renderer/film/memory_estimate.h"
#include "renderer/image/auto_exposure.h"
#include "renderer/settings/resolved_options.h"

namespace gatelight::apps {
namespace {

double count_pixels(const renderer::RenderOptions& options) {
  if (!options.region) return static_cast<double>(options.width) * options.height;
  const auto [x0, y0, x1, y1] = *options.region;
  return static_cast<double>(x1 - x0) * (y1 - y0);
}

}  // namespace

RenderRun::RenderRun(RenderSettings settings, const std::vector<std::string>& command, const RankGroup& group,
                     const RankGroup& all)
    : settings_(std::move(settings)),
      group_(group),
      all_(all),
      progress_(settings_.quiet ? ProgressMode::none : settings_.progress, count_pixels(settings_.render)) {
  report_.command = command;
  report_.hosts = group.hosts;
}

int RenderRun::run() {
  share_machines(settings_, all_);
  // A scene may take long to load.
  if (group_.ranks.first() && settings_.render.denoise.denoiser == renderer::DenoiserKind::oidn)
    renderer::load_oidn(settings_.render.denoise.library);
  for (const std::string& unused : unused_output_flags(settings_)) warn(unused);
  progress_.phase("load");
  const Clock::time_point start = Clock::now();
  scene::SceneFile file(settings_.scene, load_options());
  scene::Scene scene = file.load();
  report_.load_seconds = seconds_since(start);
  note_loaded(scene);
  if (const int number = signal(); number != 0) return stop_without_picture(number);
  expect_equal_ranks(settings_, scene, all_);
  bright_lights_ = lights_from_watts(scene);
  const std::size_t memory = require_memory_of_ranks(settings_, scene, all_);
  log_detail(fmt::format("memory needed{}, estimated: {}", all_.ranks.is_single() ? "" : " by each rank",
                         format_bytes(memory)));
  return settings_.frames.range ? render_frames(file, scene) : render_stills(scene);
}

scene::LoadOptions RenderRun::load_options() const {
  scene::LoadOptions options = settings_.load;
  const FrameSettings& frames = settings_.frames;
  if (!frames.range && options.time) *options.time += frames.shutter.middle() / frames.fps;
  return options;
}

int RenderRun::render_stills(const scene::Scene& scene) {
  std::vector<RenderSettings> pictures = pictures_of(settings_, scene);
  if (settings_.skip_existing) {
    const std::size_t count = pictures.size();
    std::erase_if(pictures, [&](const RenderSettings& picture) {
      return renderer::agreed(all_.ranks, are_there(picture.outputs));
    });
    note_skipped(count - pictures.size(), count);
    if (pictures.empty()) return kDone;
  }
  settings_ = pictures.front();
  progress_.phase("build");
  const std::size_t warnings_of_loading = report_.warnings.size();
  renderer::Renderer renderer(scene, settings_.render, group_.ranks);
  int code = make_picture(renderer);
  for (std::size_t i = 1; i < pictures.size() && code == kDone; ++i) {
    settings_ = pictures[i];
    start_ = Clock::now();
    report_.warnings.resize(warnings_of_loading);
    renderer.set_camera(settings_.render.camera);
    code = make_picture(renderer);
  }
  return code;
}

int RenderRun::make_picture(renderer::Renderer& renderer) {
  note_integrator(renderer.integrator());
  for (const std::string& warning : renderer.statistics().warnings) warn(warning);
  if (const int number = signal(); number != 0) return stop_without_picture(number);
  return end_picture(renderer.render(make_callbacks(renderer)), renderer.statistics());
}

int RenderRun::end_picture(renderer::Picture picture, const renderer::RenderStatistics& statistics) {
  report_.statistics = statistics;
  report_.signal = signal();
  if (const std::string& why = report_.statistics.denoise_failure; !why.empty())
    warn(fmt::format("the picture keeps its noise: {}", why));
  if (group_.ranks.first()) write_results(std::move(picture));
  renderer::agreed(group_.ranks, 0);  // what follows may end all ranks: rank 0 has written by now
  if (!report_.statistics.device_lost.empty())
    throw DeviceLost(fmt::format("{}; the picture so far was written", report_.statistics.device_lost));
  if (report_.signal == 0 && !report_.statistics.cache.diverged.empty())
    throw TrainingDiverged(fmt::format("{}; what was written is of its last good step, {}",
                                       report_.statistics.cache.diverged, report_.statistics.cache.steps));
  if (failed_output_) std::rethrow_exception(failed_output_);
  return report_.signal == 0 ? kDone : kSignalBase + report_.signal;
}

void RenderRun::note_integrator(renderer::Integrator chosen) {
  if (settings_.render.choose_integrator) renderer::use_integrator(settings_.render, chosen);
}

renderer::Callbacks RenderRun::make_callbacks(const renderer::Renderer& renderer) {
  return {
      .progress = [this](const renderer::Progress& progress) { progress_.update(progress); },
      .stop = [] { return stop_signal() != 0; },
      .snapshot_wanted = [] { return take_snapshot_request(); },
      .snapshot = [this, &renderer](
                      const renderer::Picture& picture) { write_snapshot(picture, renderer.statistics()); },
      .output_failed = [this](const std::exception_ptr& error,
                              bool again) { note_failed_output(error, again); },
  };
}

void RenderRun::write_pictures(renderer::Picture picture, const renderer::RenderStatistics& statistics,
                               const std::vector<std::string>& outputs) {
  renderer::ImageWriteOptions image = settings_.image;
  const float suitable = renderer::auto_exposure(picture);
  if (!settings_.exposure) image.display.exposure = suitable;
  warn_of_glare(picture, image.display, suitable);
  report_.exposure = image.display.exposure;
  picture.metadata.merge(make_recipe(settings_, report_.command, statistics, seconds_since(start_)));
  std::vector<std::exception_ptr> errors(outputs.size());
  tbb::parallel_for(std::size_t{0}, outputs.size(), [&](std::size_t i) {
    try {
      write_picture(picture, outputs[i], image);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

void RenderRun::warn_of_glare(const renderer::Picture& picture, const renderer::DisplayOptions& display,
                              float suitable) {
  if (settings_.given.contains("--exposure") || glare_reported_ || !shows_on_a_screen(settings_.outputs))
    return;
  const std::string text = glare_warning(picture, display, suitable, bright_lights_);
  if (text.empty()) return;
  glare_reported_ = true;
  warn(text);
}

void RenderRun::write_snapshot(const renderer::Picture& picture,
                               const renderer::RenderStatistics& statistics) {
  try {
    write_pictures(picture, statistics, files_of(settings_.outputs));
    progress_.clear();
    log_detail("snapshot written");
  } catch (const std::exception& error) {
    // The outputs are written again at the end of the run.
    warn(fmt::format("snapshot: {}", error.what()));
  }
}

void RenderRun::write_results(renderer::Picture picture) {
  progress_.phase("write");
  if (report_.statistics.nonfinite > 0) {
    warn(fmt::format("{} samples were not finite and are left out; --stats locates the first of them",
                     report_.statistics.nonfinite));
  }
  if (const std::string text = overflow_warning(picture, settings_.outputs, settings_.image); !text.empty())
    warn(text);
  const Clock::time_point start = Clock::now();
  write_pictures(std::move(picture), report_.statistics, settings_.outputs);
  report_.write_seconds = seconds_since(start);
  report_.total_seconds = seconds_since(start_);
  if (!settings_.stats.empty()) write_text(settings_.stats, stats_json(settings_, report_));
  if (!settings_.frames.range) print_results();
}

void RenderRun::print_results() {
  const bool as_json = progress_.done(summary_json(settings_, report_));
  if (!as_json && !settings_.quiet) print_status(summary(settings_, report_));
  if (report_.signal != 0) {
    print_notice(stop_notice(settings_, report_), kSignalBase + report_.signal);
  }
}

void RenderRun::note(const char* about, const std::string& text) {
  if (!all_.ranks.first() || settings_.quiet) return;
  progress_.clear();
  if (settings_.progress == ProgressMode::json) {
    print_json_line({{"event", "note"}, {"about", about}, {"message", text}});
  } else {
    print_status(fmt::format("{:<9} {}\n", about, text));
  }
}

void RenderRun::note_skipped(std::size_t skipped, std::size_t count) {
  note("skipped",
       fmt::format("{} of {}, which {} there already", skipped, count, skipped == 1 ? "is" : "are"));
}

void RenderRun::note_failed_output(const std::exception_ptr& error, bool again) {
  try {
    std::rethrow_exception(error);
  } catch (const std::exception& failure) {
    warn(fmt::format("{}; the picture goes on{}", failure.what(),
                     again ? ", and it will be tried again" : ""));
  }
  if (!again && !failed_output_) failed_output_ = error;
}

int RenderRun::signal() const {
  const std::vector<int> signals = renderer::one_of_each(group_.ranks, stop_signal());
  return *std::max_element(signals.begin(), signals.end());
}

int RenderRun::stop_without_picture(int signal) {
  progress_.clear();
  print_notice(fmt::format("stopped by signal {} before the first pass of '{}'; nothing was written", signal,
                           settings_.scene),
               kSignalBase + signal);
  return kSignalBase + signal;
}

void RenderRun::note_loaded(const scene::Scene& scene) {
  for (const std::string& warning : scene.warnings) warn(warning);
  if (settings_.load.time && scene.animations.empty() && settings_.frames.turntable == 0)
    warn("the file has no animations: all times are alike");
  if (!settings_.verbose) return;
  progress_.clear();
  log_detail(fmt::format("{}: {} triangles, {} instances, {} punctual lights", settings_.scene,
                         format_integer(scene::count_triangles(scene)), scene.instances.size(),
                         scene.lights.size()));
  log_detail(fmt::format("options: {}", dump_options(settings_)));
}

void RenderRun::warn(const std::string& text) {
  report_.warnings.push_back(with_flags(text));
  if (!printed_warnings_.insert(text).second) return;
  progress_.clear();
  log_warning(text);
}

}  // namespace gatelight::apps
