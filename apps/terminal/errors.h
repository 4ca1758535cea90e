#pragma once
// How the program fails: one exit code for each kind of reason, one last line on stderr.

#include <stdexcept>
#include <string>

#include "renderer/machine/errors.h"

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
  kSignalBase = 128,  ///< plus the signal's number
};

/// The command line asks for something that makes no sense. The message names flag, value and what was
/// expected.
using UsageError = renderer::BadOption;

/// An input file that cannot be used. The message names the file.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Failure {
  int code = kUsage;
  std::string message;  ///< what failed and on which file
  std::string advice;   ///< what to do
};

/// What the exception being handled means. Call it in a catch block.
Failure describe_current_exception();

/// Failures are read line by line. What a file says may hold anything: a terminal gets nothing to obey.
std::string one_line(std::string text);

/// For std::set_terminate: a failure that nobody could catch, such as a thread that cannot be started, ends
/// the program with its line and its code, too.
[[noreturn]] void end_program();

/// Prints the last line of stderr.
void print_failure(const Failure& failure);

/// The same for an end that is no failure: a signal.
void print_notice(const std::string& text);

}  // namespace gatelight::apps
