#pragma once
// How far it is, on stderr.

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "renderer/render.h"

namespace gatelight::apps {

enum class ProgressMode : std::uint8_t {
  automatic,  ///< a bar where stderr is a terminal, nothing elsewhere
  bar,
  json,  ///< one JSON object a line
  none,
};

/// May be called from any thread.
class ProgressReporter {
 public:
  /// pixels: of the region that is rendered. time_limit_seconds: of rendering; 0: none.
  ProgressReporter(ProgressMode mode, double pixels, double time_limit_seconds);
  ~ProgressReporter();
  ProgressReporter(const ProgressReporter&) = delete;
  ProgressReporter& operator=(const ProgressReporter&) = delete;

  /// A part of the work that has no measure: "load", "build", "write".
  void phase(const std::string& name);
  void update(const renderer::Progress& progress);
  /// The files are written. Says so as JSON; answers false where words are expected instead.
  bool done(const std::vector<std::string>& outputs, double seconds);
  /// Takes the bar away, so that another line can be printed; the next update brings it back.
  void clear();

 private:
  struct Rates {
    double samples_per_second = 0.0;
    double eta_seconds = -1.0;  ///< of the phase; negative: unknown
  };
  /// Whether it is the first of its phase.
  bool enter_phase(const renderer::Progress& progress);
  Rates rates(const renderer::Progress& progress) const;
  void show_json(const renderer::Progress& progress, const Rates& rates);
  void show_bar(const renderer::Progress& progress, const Rates& rates);
  void clear_line();

  std::mutex mutex_;
  ProgressMode mode_;
  double pixels_;
  double time_limit_seconds_;
  bool line_shown_ = false;
  std::chrono::steady_clock::time_point last_;
  std::optional<renderer::Phase> phase_;
  renderer::Progress first_;  ///< update of the phase; a picture that is gone on with does not begin at zero
};

}  // namespace gatelight::apps
