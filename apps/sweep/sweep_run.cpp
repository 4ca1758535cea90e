#include "apps/sweep/sweep_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/settings/complete_settings.h"
#include "apps/sweep/advise.h"
#include "apps/sweep/eta.h"
#include "apps/sweep/folder_lock.h"
#include "apps/sweep/planned.h"
#include "apps/sweep/report.h"
#include "apps/sweep/results.h"
#include "apps/sweep/results_table.h"
#include "apps/sweep/scene_sweep.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/log.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/terminal.h"
#include "apps/terminal/text.h"
#include "apps/terminal/version.h"
#include "base/clock.h"
#include "base/file/atomic_file.h"
#include "renderer/image/image_format.h"
#include "renderer/image/image_write.h"

namespace gatelight::apps {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Seconds between two writes of the results of a running sweep.
constexpr double kResultsInterval = 30.0;

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    throw OutputError(fmt::format("cannot make the folder '{}': {}", folder.string(),
                                  error ? error.message() : "a file with this name exists"));
  }
}

void check_inputs(const SweepSettings& settings, const SweepPlan& plan) {
  for (const PlannedScene& scene : plan.scenes) {
    for (const PlannedSeries& series : scene.series) {
      const RenderSettings cell =
          cell_settings(series, scene.file, plan.seeds.front(), series.points.front());
      apps::check_inputs(cell);
      check_outputs(cell);
    }
  }
  if (settings.reference_files.empty()) return;
  std::set<ReferenceKind> kinds;
  for (const PlannedScene& scene : plan.scenes) {
    for (const PlannedSeries& series : scene.series) kinds.insert(series.reference);
  }
  if (plan.scenes.size() > 1 || kinds.size() > 1) {
    throw BadOption({"reference", settings.reference_files.front(),
                     fmt::format("is one picture, but there are {} scenes with {} kinds of pictures",
                                 plan.scenes.size(), kinds.size()),
                     "`reference-spp`"});
  }
}

class SweepRun {
 public:
  SweepRun(const SweepSettings& settings, const SweepPlan& plan, std::vector<std::string> command)
      : settings_(settings),
        plan_(plan),
        command_(std::move(command)),
        progress_(settings.progress, settings.quiet),
        scenes_(plan.scenes.size()),
        tasks_(plan.scenes.size()) {
    for (std::size_t i = 0; i < scenes_.size(); ++i) {
      const PlannedScene& scene = plan.scenes[i];
      scenes_[i].scene = {{"name", scene.name}, {"file", scene.file}, {"references", ordered_json::array()}};
    }
  }

  int run() {
    prepare_folders();
    const FolderLock lock(settings_.folder);
    if (!survey()) {
      // The results of an earlier call are more complete, and stay.
      progress_.clear();
      print_notice(fmt::format("stopped by signal {} before the first cell; the same command continues",
                               stop_signal()),
                   kSignalBase + stop_signal());
      return kSignalBase + stop_signal();
    }
    print_versions();
    bool finished = true;
    bool written = false;
    for (std::size_t i = 0; finished && i < plan_.scenes.size(); ++i) {
      if (tasks_[i].empty()) continue;
      finished = run_scene(i);
      write_results();
      write_report();
      written = true;
    }
    if (!written) {
      write_results();
      write_report();
    }
    std::size_t cells = 0, failed = 0;
    for (const SceneResults& scene : scenes_) {
      cells += scene.cells.size();
      for (const ordered_json& cell : scene.cells) failed += is_done(cell) ? 0 : 1;
    }
    if (!finished) {
      progress_.clear();
      print_notice(fmt::format("stopped by signal {} with {} of {} cells in '{}'; the same command continues",
                               stop_signal(), cells - failed, plan_.cell_count(), settings_.folder),
                   kSignalBase + stop_signal());
      return kSignalBase + stop_signal();
    }
    progress_.done(settings_.folder, cells, failed);
    if (failed > 0) {
      print_failure(
          {kPartly,
           fmt::format("{} of {} cells failed; the others are in '{}'", failed, cells, settings_.folder),
           "the same command repeats them"});
      return kPartly;
    }
    return kDone;
  }

  ordered_json results() const { return make_results(command_, scenes_); }

 private:
  void prepare_folders() const {
    const fs::path folder = settings_.folder;
    for (const fs::path& needed : {folder, folder / "cells", folder / "pictures"}) make_folder(needed);
    if (settings_.reference_files.empty()) make_folder(settings_.reference_folder);
    for (const char* file : {"results.json", "results.csv", "results.md", "report.html"})
      check_writable(folder / file);
  }

  /// Finds the cells of all scenes that are done, so that results are always complete. Returns false where a
  /// signal ended it.
  bool survey() {
    // The first scene comes last and stays open.
    for (std::size_t i = plan_.scenes.size(); i-- > 0;) {
      open_scene(i);
      if (stop_signal() != 0) return false;
    }
    return true;
  }

  /// Opens a scene as open_. open_ stays empty where a signal ended it, or where the scene cannot be read:
  /// then its cells fail and the other scenes continue.
  void open_scene(std::size_t index) {
    const PlannedScene& planned = plan_.scenes[index];
    open_.reset();
    auto scene = std::make_unique<SceneSweep>(planned, plan_, settings_, progress_);
    try {
      if (!scene->open()) return;
    } catch (const OutputError&) {
      throw;
    } catch (...) {
      // With a single scene this is an ordinary error.
      if (plan_.scenes.size() == 1) throw;
      fail_scene(index, describe_current_exception().message);
      return;
    }
    tasks_[index] = scene->tasks();
    scenes_[index] = scene->results();
    open_ = std::move(scene);
    open_index_ = index;
  }

  /// Plans the tasks of this scene and the following ones.
  void plan_tasks(std::size_t scene) {
    std::vector<SweepTask> rest;
    for (std::size_t i = scene; i < tasks_.size(); ++i) {
      rest.insert(rest.end(), tasks_[i].begin(), tasks_[i].end());
    }
    progress_.plan_rest(rest);
  }

  void print_versions() const {
    std::size_t count = 0;
    std::set<std::string> others;
    for (const SceneResults& scene : scenes_) {
      for (const ordered_json& cell : scene.cells) {
        if (!is_done(cell) || cell["version"] == version()) continue;
        ++count;
        others.insert(cell["version"].get<std::string>());
      }
    }
    if (count == 0) return;
    log_warning(fmt::format("{} cell{} made by gatelight {}; remove their files in '{}' to measure again",
                            count, count == 1 ? " was" : "s were", fmt::join(others, ", "),
                            (fs::path(settings_.folder) / "cells").string()));
  }

  /// Returns false where a signal ended it.
  bool run_scene(std::size_t index) {
    // The file may have changed since the survey, so it is opened again.
    if (!open_ || open_index_ != index) open_scene(index);
    if (!open_) return stop_signal() == 0;
    plan_tasks(index);
    Clock::time_point written = Clock::now();
    const bool finished = open_->run([&] {
      scenes_[index] = open_->results();
      if (seconds_since(written) < kResultsInterval) return;
      write_results();
      written = Clock::now();
    });
    scenes_[index] = open_->results();
    return finished;
  }

  void fail_scene(std::size_t index, const std::string& error) {
    const PlannedScene& planned = plan_.scenes[index];
    tasks_[index].clear();
    scenes_[index].cells.clear();
    for (const PlannedSeries& series : planned.series) {
      for (const std::uint32_t seed : plan_.seeds) {
        for (const int point : series.points) {
          // Without a scene there is no fingerprint; no other cell has such a name.
          const std::string id =
              fmt::format("{}-{}-{}-{}", planned.name, &series - planned.series.data(), seed, point);
          scenes_[index].cells.push_back(failed_record({planned, series, seed, point, id, ""}, error));
        }
      }
    }
    progress_.clear();
    log_warning(fmt::format("{}: all of its cells failed: {}", planned.name, error));
  }

  void write_results() const {
    const fs::path folder = settings_.folder;
    const ordered_json all = results();
    write_file_atomically(folder / "results.json", json_text(all) + "\n");
    write_file_atomically(folder / "results.csv", results_csv(all));
    write_file_atomically(folder / "results.md", results_table(all));
  }

  void write_report() const {
    const fs::path folder = settings_.folder;
    write_file_atomically(folder / "report.html", make_report(results(), settings_.folder));
  }

  const SweepSettings& settings_;
  const SweepPlan& plan_;
  std::vector<std::string> command_;
  SweepProgress progress_;
  std::vector<SceneResults> scenes_;
  std::vector<std::vector<SweepTask>> tasks_;  ///< missing tasks of each scene
  std::unique_ptr<SceneSweep> open_;           ///< one scene at a time is in memory
  std::size_t open_index_ = 0;
};

AdviceReport advice_of_folder(const std::string& folder, const AdviceLimits& limits) {
  const ordered_json results = read_results(folder);
  try {
    return give_advice(results, limits);
  } catch (const ordered_json::exception& error) {
    throw InputError(fmt::format("cannot read '{}': it is not the result of a sweep: {}",
                                 results_file(folder), error.what()));
  }
}

/// Prints the advice. Returns the exit code.
int print_advice(const AdviceReport& advice) {
  write_text("-", advice.text);
  if (advice.unmet.empty()) return kDone;
  print_failure({kNoAdvice, "--advise: " + advice.unmet,
                 advice.text.empty() ? "see its failures"
                                     : "the closest is on stdout; raise the limit or measure more"});
  return kNoAdvice;
}

}  // namespace

int run_sweep(const SweepSettings& given, const std::vector<std::string>& command) {
  SweepSettings settings = given;
  if (settings.reference_folder.empty()) {
    settings.reference_folder = (fs::path(settings.folder) / "references").string();
  }
  set_log_level(settings.quiet, settings.verbose);
  if (settings.request.scenes.empty()) {
    return print_advice(advice_of_folder(settings.folder, settings.limits));
  }
  const SweepPlan plan = make_plan(settings.request);
  check_inputs(settings, plan);
  if (settings.dry_run) {
    write_text("-", plan_text(plan));
    return kDone;
  }
  install_signal_handlers();
  SweepRun run(settings, plan, command);
  const int code = run.run();
  if (!settings.advise || code >= kSignalBase) return code;
  const AdviceReport advice = give_advice(run.results(), settings.limits);
  if (code == kDone) return print_advice(advice);
  // The failure was printed already, in the last line of stderr.
  write_text("-", advice.text);
  return code;
}

}  // namespace gatelight::apps
