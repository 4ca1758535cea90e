#pragma once
// Runs the real program.

#include <sys/types.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/support/messages.h"
#include "tests/support/words.h"

namespace gatelight::tests {

struct Output {
  int exit_code = -1;   ///< 128 + signal where a signal ended it, as in a shell
  bool killed = false;  ///< by a signal
  std::string out;
  std::string err;

  std::vector<std::string> error_lines() const;
  std::vector<std::string> warnings() const;
  std::string last_error_line() const { return err.empty() ? "" : error_lines().back(); }
};

/// A run of gatelight that is under way.
class Process {
 public:
  /// `prepare` runs in the new process before the program: limits, other descriptors. It may only make system
  /// calls.
  explicit Process(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void send(int signal) const;
  pid_t id() const { return pid_; }
  /// Whether it has not ended yet.
  bool runs() const;
  /// Reads stderr until the text is in it. False where the program ends before.
  bool wait_for_error_text(const std::string& text);
  /// Reads the rest and waits for the end; kills the program after a minute.
  Output finish();

 private:
  bool read_some(int timeout_ms);

  pid_t pid_ = -1;
  int out_ = -1;
  int err_ = -1;
  Output output_;
};

/// Runs gatelight within this process: for runs that fail early.
Output run_gatelight_inside(const std::vector<std::string>& arguments);

Output run_gatelight(const std::vector<std::string>& arguments, const std::function<void()>& prepare = {});

/// Expects exit code 0.
Output expect_done(Output output, Place place = Place::current());

/// Expects that it ended by itself with this code, and that stderr is one line, an error that has all the
/// names in it.
void expect_failure(const Output& output, int exit_code, const NameList& names,
                    Place place = Place::current());

}  // namespace gatelight::tests
