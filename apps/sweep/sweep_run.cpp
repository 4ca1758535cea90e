#include "apps/sweep/sweep_run.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <deque>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "apps/settings/complete_settings.h"
#include "apps/sweep/advise.h"
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

/// Allows one sweep at a time in a folder, until it is destroyed or the program ends, however it ends.
class FolderLock {
 public:
  /// Throws InputError where another process has the lock, OutputError where FOLDER/.lock cannot be opened.
  /// On a file system without locks there is no protection.
  explicit FolderLock(const std::string& folder) {
    const std::string file = (std::filesystem::path(folder) / ".lock").string();
    descriptor_ = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
      throw OutputError(fmt::format("cannot write '{}': {}", file, std::generic_category().message(errno)));
    }
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    ::close(descriptor_);
    throw InputError(fmt::format("'{}': another sweep is at work here, expected one at a time", folder));
  }
  ~FolderLock() { ::close(descriptor_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

class SweepRun {
 public:
  SweepRun(const SweepSettings& settings, const SweepPlan& plan, std::vector<std::string> command)
      : settings_(settings),
        plan_(plan),
        command_(std::move(command)),
        progress_(settings.progress, settings.quiet) {
    for (const PlannedScene& scene : plan.scenes) scenes_.emplace_back(scene, plan, settings, progress_);
  }

  int run() {
    prepare_folders();
    const FolderLock lock(settings_.folder);
    // The results of an earlier call are more complete, and stay.
    if (!survey()) return stopped("before the first cell");
    print_versions();
    bool finished = true;
    bool written = false;
    for (std::size_t i = 0; finished && i < scenes_.size(); ++i) {
      if (!scenes_[i].tasks().empty()) {
        finished = run_scene(i);
        write_all();
        written = true;
      }
      scenes_[i].close();
    }
    if (!written) write_all();
    const ordered_json made = results()["cells"];
    const std::size_t cells = made.size();
    const auto failed = static_cast<std::size_t>(
        std::count_if(made.begin(), made.end(), [](const ordered_json& cell) { return !is_done(cell); }));
    if (!finished)
      return stopped(
          fmt::format("with {} of {} cells in '{}'", cells - failed, plan_.cell_count(), settings_.folder));
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

  ordered_json results() const {
    std::vector<SceneResults> scenes;
    for (const SceneSweep& scene : scenes_) scenes.push_back(scene.results());
    return make_results(command_, scenes);
  }

 private:
  void prepare_folders() const {
    const fs::path folder = settings_.folder;
    for (const fs::path& needed : {folder, folder / "cells", folder / "pictures"}) make_folder(needed);
    if (settings_.reference_files.empty()) make_folder(settings_.reference_folder);
    for (const char* file : {"results.json", "results.csv", "results.md", "report.html"})
      check_writable(folder / file);
  }

  /// Says that a signal ended the sweep. Returns the exit code.
  int stopped(const std::string& when) {
    const int code = kSignalBase + stop_signal();
    progress_.clear();
    print_notice(fmt::format("stopped by signal {} {}; the same command goes on", stop_signal(), when), code);
    return code;
  }

  /// Finds the cells of all scenes that are done, so that results are always complete. Returns false where a
  /// signal ended it.
  bool survey() {
    // The first scene comes last and stays open.
    for (std::size_t i = scenes_.size(); i-- > 0;) {
      if (!scenes_[i].open()) return false;
      if (i > 0) scenes_[i].close();
    }
    return true;
  }

  /// Plans the tasks of this scene and the following ones.
  void plan_tasks(std::size_t scene) {
    std::vector<SweepTask> rest;
    for (std::size_t i = scene; i < scenes_.size(); ++i) {
      const std::vector<SweepTask> tasks = scenes_[i].tasks();
      rest.insert(rest.end(), tasks.begin(), tasks.end());
    }
    progress_.plan_rest(rest);
  }

  void print_versions() const {
    std::size_t count = 0;
    std::set<std::string> others;
    const ordered_json all = results();
    for (const ordered_json& cell : all["cells"]) {
      if (!is_done(cell) || cell["version"] == version()) continue;
      ++count;
      others.insert(cell["version"].get<std::string>());
    }
    if (count == 0) return;
    log_warning(fmt::format("{} cell{} made by gatelight {}; remove their files in '{}' to measure again",
                            count, count == 1 ? " was" : "s were", fmt::join(others, ", "),
                            (fs::path(settings_.folder) / "cells").string()));
  }

  /// Returns false where a signal ended it.
  bool run_scene(std::size_t index) {
    SceneSweep& scene = scenes_[index];
    // The file may have changed since the survey, so it is opened again.
    if (!scene.is_open() && !scene.open()) return false;
    plan_tasks(index);
    Clock::time_point written = Clock::now();
    return scene.run([&] {
      if (seconds_since(written) < kResultsInterval) return;
      write_results();
      written = Clock::now();
    });
  }

  /// Returns what it wrote.
  ordered_json write_results() const {
    const fs::path folder = settings_.folder;
    ordered_json all = results();
    write_file_atomically(folder / "results.json", json_text(all) + "\n");
    write_file_atomically(folder / "results.csv", results_csv(all));
    write_file_atomically(folder / "results.md", results_table(all));
    return all;
  }

  void write_all() const {
    write_file_atomically(fs::path(settings_.folder) / "report.html",
                          make_report(write_results(), settings_.folder));
  }

  const SweepSettings& settings_;
  const SweepPlan& plan_;
  std::vector<std::string> command_;
  SweepProgress progress_;
  std::deque<SceneSweep> scenes_;  ///< one at a time is in memory
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
