#pragma once

#include <stdexcept>

namespace gatelight::scene {

/// A file that cannot be used. The message names the file, the offending value and what was expected, in one
/// line.
struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace gatelight::scene
