#pragma once
// Failures of the program: an exit code for each kind of reason, and one last line on stderr.

#include <functional>
#include <string>

#include "base/errors.h"

namespace gatelight::apps {

/// The codes are part of the command line's contract (see README.md).
enum ExitCode : int {
  kDone = 0,
  kUsage = 1,
  kInput = 2,
  kOutput = 3,
  kMemory = 4,
  kUnavailable = 5,
  kNumerical = 6,
  kPartly = 7,        ///< some cells of a sweep failed, the others are there
  kNoAdvice = 8,      ///< nothing in a sweep meets the limits of --advise
  kLost = 9,          ///< another process of a run on several machines does not answer
  kSignalBase = 128,  ///< plus the signal's number
};

struct Failure {
  int code = kUsage;
  std::string message;  ///< what failed and on which file
  std::string advice;   ///< what to do
  bool operator==(const Failure&) const = default;
};

/// Describes the exception that is being handled, which may be a Failure. Call it in a catch block.
Failure describe_current_exception();

/// For std::set_terminate: a failure that could not be caught, such as a thread that cannot be started, also
/// ends the program with its line and its code.
[[noreturn]] void end_program();

/// Prints the last line of stderr.
void print_failure_line(const Failure& failure);

/// Gives the failure to the handler; without one, prints the last line of stderr.
void print_failure(const Failure& failure);

/// Sets the handler: where several processes run one command, one of them prints. Without a handler this
/// process prints its failures itself.
void handle_failures(std::function<void(const Failure&)> handler);

/// Prints the last line of stderr after a signal, which is no failure. The code is the program's.
void print_notice(const std::string& text, int code);

}  // namespace gatelight::apps
