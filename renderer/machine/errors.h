#pragma once
// The exceptions by which the renderer refuses a request. For other unusable input it throws
// std::runtime_error.

#include <stdexcept>

namespace gatelight::renderer {

/// A request needs more memory than there is or than the limit allows. The message gives both sizes.
struct OutOfMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A sample is not finite under NanPolicy::error. The message gives its place.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The training loss grows without bound or is not finite. The message names the step.
struct TrainingDiverged : NumericalError {
  using NumericalError::NumericalError;
};

/// The requested device or instruction set is not available.
struct Unavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The denoiser is not there, is of another version, or does not run on this machine.
struct MissingDenoiser : Unavailable {
  using Unavailable::Unavailable;
};

/// A library that is loaded on demand cannot be. The message gives the loader's reason.
struct MissingLibrary : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An option cannot be satisfied (an unknown camera, an empty region). The message names the value and the
/// choices.
struct BadOption : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

}  // namespace gatelight::renderer
