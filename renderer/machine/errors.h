#pragma once
// The ways in which the renderer refuses. Everything else is std::runtime_error: unusable input.

#include <stdexcept>

namespace gatelight::renderer {

/// More memory than there is or than the limit allows. The message holds the bytes needed and allowed.
struct OutOfMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A non-finite sample under NanPolicy::error. The message locates it.
struct NumericalError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The loss grew without end or is not finite. The message names the step.
struct TrainingDiverged : NumericalError {
  using NumericalError::NumericalError;
};

/// The device or instruction set asked for is not there.
struct Unavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// An option that no scene can satisfy (an unknown camera, an empty region). The message names value and
/// choices.
struct BadOption : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

}  // namespace gatelight::renderer
