#pragma once
// The exceptions of the library.

#include <stdexcept>

namespace gatelight::neural {

/// A configuration or a batch is invalid. The message names the value and what was expected.
struct BadConfiguration : std::invalid_argument {
  using std::invalid_argument::invalid_argument;
};

/// The requested instruction set or device is not available. The message lists what is.
struct Unavailable : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The device stopped working during use.
struct DeviceLost : Unavailable {
  using Unavailable::Unavailable;
};

/// The device has less memory than is needed. The message names both.
struct OutOfDeviceMemory : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Vulkan's validation layer found a mistake of the program.
struct ValidationFailed : std::logic_error {
  using std::logic_error::logic_error;
};

/// A cache file cannot be read or belongs to another model. The message names file and difference.
struct CacheFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A file cannot be written. The message names the file and the reason.
struct OutputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace gatelight::neural
