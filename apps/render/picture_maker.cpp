#include "apps/render/picture_maker.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "apps/job/finished_picture.h"
#include "apps/reports/picture_warnings.h"
#include "apps/settings/picture_output.h"
#include "apps/settings/unused_flags.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/terminal.h"
#include "renderer/image/auto_exposure.h"

namespace gatelight::apps {

PictureMaker::PictureMaker(Console& console_in, const RunTeam& team_in, std::string bright_lights)
    : console(console_in), team(team_in), bright_lights_(std::move(bright_lights)) {}

void PictureMaker::begin(const RenderSettings& settings, Clock::time_point start) {
  settings_ = settings;
  start_ = start;
}

renderer::Callbacks PictureMaker::callbacks(const renderer::Renderer& renderer) {
  return {
      .progress = [this](const renderer::Progress& progress) { console.progress.update(progress); },
      .stop = [] { return stop_signal() != 0; },
      .snapshot_wanted = [] { return take_snapshot_request(); },
      .snapshot = [this, &renderer](
                      const renderer::Picture& picture) { write_snapshot(picture, renderer.statistics()); },
      .output_failed = [this](const std::exception_ptr& error,
                              bool again) { note_failed_output(error, again); },
  };
}

int PictureMaker::finish(renderer::Picture picture, const renderer::RenderStatistics& statistics) {
  RunReport& report = console.report;
  report.statistics = statistics;
  report.signal = team.signal();
  team.describe(report);
  console.warn(warnings_of(statistics));
  if (team.writes()) write_results(std::move(picture));
  team.wait_for_writer();  // what follows may end all of them
  require_good_end(statistics, true);
  if (failed_output_) std::rethrow_exception(failed_output_);
  return report.signal == 0 ? kDone : kSignalBase + report.signal;
}

void PictureMaker::write(renderer::Picture picture, const renderer::RenderStatistics& statistics,
                         const std::vector<std::string>& outputs) {
  const renderer::ImageWriteOptions image =
      finish_picture(picture, settings_, statistics, seconds_since(start_), console.report);
  warn_of_glare(picture, image.display);
  write_pictures(picture, outputs, image);
}

void PictureMaker::warn_of_glare(const renderer::Picture& picture, const renderer::DisplayOptions& display) {
  if (!settings_.exposure || settings_.given.contains("exposure") || glare_reported_ ||
      !shows_on_a_screen(settings_.outputs))
    return;
  const std::string text = glare_warning(picture, display, renderer::auto_exposure(picture), bright_lights_);
  if (text.empty()) return;
  glare_reported_ = true;
  console.warn(text);
}

void PictureMaker::write_snapshot(const renderer::Picture& picture,
                                  const renderer::RenderStatistics& statistics) {
  try {
    write(picture, statistics, files_of(settings_.outputs));
    console.progress.clear();
    log_detail("snapshot written");
  } catch (const std::exception& error) {
    // The outputs are written again at the end of the run.
    console.warn(fmt::format("snapshot: {}", error.what()));
  }
}

void PictureMaker::write_results(renderer::Picture picture) {
  RunReport& report = console.report;
  console.progress.phase("write");
  if (const std::string text = overflow_warning(picture, settings_.outputs, settings_.image); !text.empty())
    console.warn(text);
  const Clock::time_point start = Clock::now();
  write(std::move(picture), report.statistics, settings_.outputs);
  report.write_seconds = seconds_since(start);
  report.total_seconds = seconds_since(start_);
  if (!settings_.stats.empty()) write_text(settings_.stats, stats_json(settings_, report));
  if (settings_.frames.range) return;
  const bool as_json = console.progress.done(summary_json(settings_, report));
  if (!as_json && !console.quiet()) print_status(summary(settings_, report));
  if (report.signal != 0) print_notice(stop_notice(settings_, report), kSignalBase + report.signal);
}

void PictureMaker::note_failed_output(const std::exception_ptr& error, bool again) {
  try {
    std::rethrow_exception(error);
  } catch (const std::exception& failure) {
    console.warn(fmt::format("{}; rendering continues{}", failure.what(),
                             again ? ", and the write will be retried" : ""));
  }
  if (!again && !failed_output_) failed_output_ = error;
}

}  // namespace gatelight::apps
