#pragma once

#include <cstdint>
#include <string>

#include "scene/math.h"

namespace gatelight::renderer {

/// What the camera sees where it sees past the scene: directly, through holes, and through panes, which do
/// not bend light. Mirrors and glass with an inside show the environment, which lights the scene in any case.
struct BackgroundOptions {
  enum class Kind : std::uint8_t {
    scene,        ///< the environment
    transparent,  ///< nothing: the picture has an alpha
    color,        ///< one radiance
    file,         ///< a picture, scaled to cover the view
  };
  Kind kind = Kind::scene;
  scene::Color color{0.0f, 0.0f, 0.0f};
  std::string file;
  /// A node of the scene, whose objects the camera does not see but for the shadows on them; empty: none.
  std::string shadow_catcher;

  /// Whether the environment is left out of the view.
  bool apart() const { return kind != Kind::scene; }
};

}  // namespace gatelight::renderer
