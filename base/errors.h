#pragma once
// The exceptions of the libraries. Each has a kind, so that a program can handle all of them with one table.

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace gatelight {

enum class ErrorKind : std::uint8_t {
  option,             ///< an option cannot be satisfied
  model,              ///< a configuration of a model, or a batch, is invalid
  format,             ///< no codec for the extension of a file name
  input,              ///< an input file cannot be used
  cache_file,         ///< a cache file is damaged or belongs to another model
  output,             ///< a file cannot be written
  memory,             ///< the machine or a limit has too little memory
  device_memory,      ///< the device has too little memory
  unavailable,        ///< the instruction set or the device is missing
  denoiser,           ///< the denoiser is missing
  library,            ///< a library that is loaded on demand is missing
  device_lost,        ///< the device stopped working
  numerical,          ///< a sample is not finite
  training_diverged,  ///< the training loss is not finite or grows without bound
  mpi                 ///< a function of MPI failed
};

/// An error about an option as data. Fields that do not apply are empty.
struct ErrorParts {
  std::string option{};    ///< name in the option table, such as "max-depth"; capitals for an argument
  std::string value{};     ///< as text
  std::string problem{};   ///< a clause such as "has 5 levels"; empty if the value is merely not as expected
  std::string expected{};  ///< a noun phrase, "an integer from 1 to 5"
  std::string hint{};      ///< a suggestion, from did_you_mean()
};

/// Formats the parts as a sentence, such as "spp: 'x' is not an integer from 1 to 5", "stack: '1,2,3' has 3
/// levels, expected at most 2" or "fps: there are no frames, expected `frames` or `turntable`".
std::string sentence(const ErrorParts& parts);

/// Control characters become spaces, so that text of a file or a library is safe to print in one line.
std::string one_line(std::string text);

/// The message is one line and names the file or option, the value and what was expected. Names of other
/// options are in back-ticks.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  Error(ErrorKind kind, ErrorParts parts);
  ErrorKind kind() const { return kind_; }
  /// Empty if the error is not about an option but, for example, about a file or memory.
  const ErrorParts& parts() const { return parts_; }

 private:
  ErrorKind kind_;
  ErrorParts parts_;
};

/// An error of one kind, derived from a more general class.
template <ErrorKind kKind, class Base = Error>
class ErrorOf : public Base {
 public:
  explicit ErrorOf(const std::string& message) : Base(kKind, message) {}
  explicit ErrorOf(ErrorParts parts) : Base(kKind, std::move(parts)) {}

 protected:
  ErrorOf(ErrorKind kind, const std::string& message) : Base(kind, message) {}
  ErrorOf(ErrorKind kind, ErrorParts parts) : Base(kind, std::move(parts)) {}
};

using BadOption = ErrorOf<ErrorKind::option>;
using BadConfiguration = ErrorOf<ErrorKind::model>;
using UnknownFormat = ErrorOf<ErrorKind::format>;
using InputError = ErrorOf<ErrorKind::input>;
using CacheFileError = ErrorOf<ErrorKind::cache_file>;
using OutputError = ErrorOf<ErrorKind::output>;
using OutOfMemory = ErrorOf<ErrorKind::memory>;
using OutOfDeviceMemory = ErrorOf<ErrorKind::device_memory>;
using Unavailable = ErrorOf<ErrorKind::unavailable>;
using MissingDenoiser = ErrorOf<ErrorKind::denoiser, Unavailable>;
using MissingLibrary = ErrorOf<ErrorKind::library>;
using DeviceLost = ErrorOf<ErrorKind::device_lost, Unavailable>;
using NumericalError = ErrorOf<ErrorKind::numerical>;
using TrainingDiverged = ErrorOf<ErrorKind::training_diverged, NumericalError>;
using MpiError = ErrorOf<ErrorKind::mpi>;

}  // namespace gatelight
