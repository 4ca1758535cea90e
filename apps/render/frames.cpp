#include "apps/render/frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "apps/job/frame_sequence.h"
#include "apps/job/frame_settings.h"
#include "apps/reports/run_report.h"
#include "apps/settings/camera_names.h"
#include "apps/settings/complete_settings.h"
#include "apps/settings/picture_output.h"
#include "apps/settings/unused_flags.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/signals.h"
#include "apps/terminal/terminal.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

/// The frames of one camera.
class FrameRun {
 public:
  FrameRun(const RenderSettings& settings, scene::SceneFile& file, scene::Scene& scene, PictureMaker& maker)
      : settings_(settings), file_(file), scene_(scene), maker_(maker), console_(maker.console) {}

  /// Returns the exit code.
  int run() {
    const std::vector<int> all = settings_.frames.range->numbers();
    const std::set<int> existing = existing_frames(all);
    if (existing.size() == all.size()) {
      report(0, 0.0);
      return kDone;
    }
    console_.progress.phase("build");
    begin_ = Clock::now();
    const std::string before = state_before();
    FrameSequence sequence = make_sequence();
    check_frame_groups(settings_.frames, sequence.renderer().chosen().integrator);
    if (before.empty()) note_part(sequence, all, existing);
    warnings_of_loading_ = console_.report.warnings.size();
    const std::optional<int> done = begin(sequence, before);
    std::vector<int> frames(done ? std::find(all.begin(), all.end(), *done) + 1 : all.begin(), all.end());
    std::erase_if(frames, [&](int frame) { return existing.contains(frame); });
    return render(sequence, maker_.team.own_frames(frames), frames.size());
  }

  /// The first failure of a frame that was not reported.
  const std::exception_ptr& failure() const { return failure_; }

 private:
  /// With --skip-existing: the frames whose files are there.
  std::set<int> existing_frames(const std::vector<int>& frames) {
    std::set<int> existing;
    if (!settings_.skip_existing) return existing;
    for (const int frame : frames) {
      if (maker_.team.agreed(are_there(settings_of_frame(settings_, frame).outputs))) existing.insert(frame);
    }
    console_.note_skipped(existing.size(), frames.size());
    return existing;
  }

  /// The file from which the frames go on, --checkpoint or --cache-in, empty for none. Takes its exposure.
  std::string state_before() {
    const std::string& checkpoint = settings_.render.checkpoint.file;
    const bool resumed = settings_.render.checkpoint.resume && std::filesystem::exists(checkpoint);
    const std::string before = resumed ? checkpoint : settings_.render.cache.cache_in;
    if (before.empty()) return before;
    const renderer::FrameStatus status = renderer::read_frame_status(before);
    if (!settings_.exposure) settings_.exposure = status.exposure;
    if (!status.of_animation && scene_.motion.any())
      throw CacheFileError(fmt::format("{}: made for a still picture, expected a cache of --frames", before));
    return before;
  }

  FrameSequence make_sequence() {
    FrameSequence sequence(
        settings_, scene_, [this](double seconds) { file_.show(scene_, seconds); },
        shows_on_a_screen(settings_.outputs));
    if (sequence.needs_exposure()) {
      console_.progress.phase("exposure");
      sequence.measure_exposure([] { return stop_signal() != 0; });
      const float exposure = *sequence.settings().exposure;
      const std::vector<int>& sample = sequence.sample();
      console_.note(
          "exposure",
          fmt::format("{:.1f} EV, measured in {} of the frames 0 to {}; --exposure {:.1f} sets the same",
                      exposure, sample.size(), sample.back(), exposure));
    }
    settings_ = sequence.settings();
    return sequence;
  }

  /// Says that frames of a part of the film differ from those of a run of all, where they do.
  void note_part(const FrameSequence& sequence, const std::vector<int>& frames,
                 const std::set<int>& existing) {
    const renderer::RenderOptions& options = settings_.render;
    const bool cached = renderer::uses_cache(options.integrator);
    const bool carried = options.denoise.denoiser != renderer::DenoiserKind::none && options.denoise.temporal;
    const int last = sequence.sample().back();
    const bool whole = existing.empty() && frames.front() <= 0 && frames.back() >= last - 1 &&
                       (frames.size() < 2 || common_step(frames) == 1);
    if (whole || last == 0 || (!cached && !carried)) return;
    console_.note(
        "part", fmt::format("of an animation with frames 0 to {}: these frames differ slightly from those of "
                            "a complete run, because of {}{}{}; --integrator path --temporal off avoids this",
                            last, cached ? "the reused cache" : "", cached && carried ? " and " : "",
                            carried ? "reused samples" : ""));
  }

  /// Makes the cache, or takes what is in `before`. Returns the last frame that is done, where the run is
  /// resumed.
  std::optional<int> begin(FrameSequence& sequence, const std::string& before) {
    if (before.empty()) {
      sequence.begin();
      return {};
    }
    const std::optional<int> last = sequence.begin_from(before);
    if (before != settings_.render.checkpoint.file) return {};
    const std::vector<int> frames = settings_.frames.range->numbers();
    if (last && std::find(frames.begin(), frames.end(), *last) == frames.end())
      throw CacheFileError(fmt::format("{}: it ends with frame {}, expected one of --frames", before, *last));
    return last;
  }

  /// `count`: of the frames of all processes.
  int render(FrameSequence& sequence, const std::vector<int>& frames, std::size_t count) {
    int number = 0;
    std::size_t i = 0;
    for (; i < frames.size(); ++i) {
      console_.report.warnings.resize(warnings_of_loading_);
      console_.progress.begin_frame(frames[i], i, frames.size());
      try {
        number = make_frame(sequence, frames[i], i + 1 == frames.size());
      } catch (const OutOfMemory&) {
        throw;
      } catch (const DeviceLost&) {
        throw;
      } catch (const std::exception&) {
        if (!maker_.team.is_alone()) throw;  // the others wait for this one
        note_failed_frame(frames[i]);
      }
      if (number != 0) break;
    }
    const FrameResults all = maker_.team.joined({number, i, console_.printed_warnings(), failure_});
    if (all.signal != 0) return note_stop(all.signal, all.done, count);
    for (const std::string& warning : all.warnings) console_.warn(warning);
    report(count, seconds_since(begin_));
    failure_ = all.failure;
    return kDone;
  }

  /// Returns the number of a signal that ended it, or 0.
  int make_frame(FrameSequence& sequence, int frame, bool last) {
    const RenderSettings settings = settings_of_frame(settings_, frame);
    maker_.begin(settings);
    make_folders(frame);
    sequence.show(frame);
    console_.warn(scene_.warnings);
    console_.warn(sequence.renderer().statistics().warnings);
    if (const int number = maker_.team.signal(); number != 0) return number;
    renderer::Picture picture = sequence.render(frame, maker_.callbacks(sequence.renderer()));
    // An unfinished frame would look like a finished one.
    if (const int number = maker_.team.signal(); number != 0) return number;
    maker_.finish(std::move(picture), sequence.renderer().statistics());
    if (!maker_.team.writes()) return 0;
    write_state(sequence, frame, last);
    const RunReport& report = console_.report;
    if (!console_.progress.frame_done(frame, summary_json(settings, report)) && !console_.quiet()) {
      console_.progress.clear();
      print_status(frame_line(frame, settings, report));
    }
    return 0;
  }

  void make_folders(int frame) const {
    if (!maker_.team.writes()) return;
    for (const std::string& output : settings_.outputs) make_folders_of_frame(output, frame);
    for (const std::string& file : {settings_.stats, settings_.render.cache.cache_out})
      make_folders_of_frame(file, frame);
  }

  /// Writes --checkpoint and --cache-out.
  void write_state(const FrameSequence& sequence, int frame, bool last) const {
    const std::string& checkpoint = settings_.render.checkpoint.file;
    const std::string& cache = settings_.render.cache.cache_out;
    if (!checkpoint.empty()) sequence.write(checkpoint);
    if (!cache.empty() && (has_frame_place(cache) || last)) sequence.write(name_of_frame(cache, frame));
  }

  /// Keeps the failure of one frame, so that the others are rendered.
  void note_failed_frame(int frame) {
    if (!failure_) failure_ = std::current_exception();
    console_.warn(fmt::format("frame {} failed: {}", frame, describe_current_exception().message));
  }

  int note_stop(int signal, std::size_t done, std::size_t count) {
    return console_.note_signal(
        signal, fmt::format("after {} of {} frames; the unfinished frame is lost{}", done, count,
                            settings_.render.checkpoint.file.empty() ? "" : ", --resume continues with it"));
  }

  void report(std::size_t count, double seconds) {
    if (console_.progress.done({{"frames", count}, {"seconds", seconds}}) || console_.quiet()) return;
    print_status(frames_summary(count, seconds, console_.report));
  }

  RenderSettings settings_;  ///< of all frames
  scene::SceneFile& file_;
  scene::Scene& scene_;
  PictureMaker& maker_;
  Console& console_;
  Clock::time_point begin_;
  std::size_t warnings_of_loading_ = 0;
  std::exception_ptr failure_;
};

}  // namespace

int render_frames(const RenderSettings& settings, scene::SceneFile& file, scene::Scene& scene,
                  PictureMaker& maker) {
  std::exception_ptr failure;
  for (const RenderSettings& of_camera : pictures_of(settings, scene)) {
    FrameRun run(of_camera, file, scene, maker);
    if (const int signal_code = run.run(); signal_code != kDone) return signal_code;
    if (!failure) failure = run.failure();
  }
  maker.team.agreed(true);  // waits for the one that prints: what follows may end all
  if (failure) std::rethrow_exception(failure);
  return kDone;
}

}  // namespace gatelight::apps
