#pragma once

#include <stdexcept>

namespace gatelight::scene {

/// Thrown for a file that cannot be used. The one-line message names the file, the wrong value and what was
/// expected.
struct SceneError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace gatelight::scene
