#pragma once
// What `gatelight render` prints while it works, and its report.

#include <cstddef>
#include <set>
#include <string>
#include <vector>

#include "apps/reports/run_report.h"
#include "apps/terminal/progress.h"

namespace gatelight::apps {

class Console {
 public:
  explicit Console(const RenderSettings& settings);

  /// Prints what was not printed before, and adds it to the report of the picture.
  void warn(const std::string& text);
  void warn(const std::vector<std::string>& texts);
  /// Prints a line; with --progress json as an event.
  void note(const char* about, const std::string& text);
  /// How many pictures --skip-existing has left out.
  void note_skipped(std::size_t skipped, std::size_t count);
  /// Prints a line about a signal, which is no failure. Returns the exit code.
  int note_signal(int signal, const std::string& text);

  bool quiet() const { return quiet_; }
  const std::set<std::string>& printed_warnings() const { return printed_; }

  ProgressReporter progress;
  RunReport report;

 private:
  bool quiet_, json_;
  std::set<std::string> printed_;
};

}  // namespace gatelight::apps
