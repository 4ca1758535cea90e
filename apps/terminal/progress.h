#pragma once
// Progress on stderr.

#include <cstdint>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "base/clock.h"
#include "renderer/render.h"

namespace gatelight::apps {

enum class ProgressMode : std::uint8_t {
  automatic,  ///< a bar where stderr is a terminal, nothing elsewhere
  bar,
  json,  ///< one JSON object per line
  none,
};

/// "scout", "train", "render" or "denoise".
std::string word_of(renderer::Phase phase);

/// A status line on stderr that is redrawn in place, or JSON lines.
class ProgressLine {
 public:
  explicit ProgressLine(ProgressMode mode);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Erases the line, so that another can be printed; the next update draws it again. Thread-safe.
  void clear();

 protected:
  // The caller holds the mutex.
  void show_line(const std::string& text);
  void clear_line();
  /// Whether enough time has passed since the last line, or this one cannot wait.
  bool due(bool must);

  std::mutex mutex_;
  ProgressMode mode_;  ///< not automatic

 private:
  bool line_shown_ = false;
  Clock::time_point last_;
};

/// Thread-safe.
class ProgressReporter : public ProgressLine {
 public:
  /// pixels: of the region that is rendered.
  ProgressReporter(ProgressMode mode, double pixels);

  /// Begins a phase without measurable progress: "load", "build", "write".
  void phase(const std::string& name);
  void update(const renderer::Progress& progress);
  /// From now on the progress is that of a frame, after `done` of `count`, with the ETA of all.
  void begin_frame(int frame, std::size_t done, std::size_t count);
  /// Reports that a frame is written, as JSON. Returns false in other modes.
  bool frame_done(int frame, const nlohmann::ordered_json& summary);
  /// Reports that the files are written, as JSON. Returns false in other modes, where the caller prints text.
  bool done(const nlohmann::ordered_json& summary);

 private:
  struct Rates {
    double samples_per_second = 0.0;
    double eta_seconds = -1.0;  ///< of the phase; negative: unknown
  };
  /// Whether the update is the first of its phase.
  bool enter_phase(const renderer::Progress& progress);
  Rates rates(const renderer::Progress& progress) const;
  void show_json(const renderer::Progress& progress, const Rates& rates);
  void show_bar(const renderer::Progress& progress, const Rates& rates);

  /// One of several frames.
  struct Frame {
    int number = 0;
    std::size_t done = 0, count = 0;
    Clock::time_point begin;  ///< of this one
  };
  /// Seconds left of all frames; negative: unknown.
  double eta_of_frames() const;

  double pixels_;
  std::optional<Frame> frame_;
  Clock::time_point first_frame_;  ///< its begin
  std::optional<renderer::Phase> phase_;
  renderer::Progress first_;  ///< update of the phase; a resumed picture does not begin at zero
};

}  // namespace gatelight::apps
