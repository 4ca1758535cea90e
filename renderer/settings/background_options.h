#pragma once

#include <cstdint>
#include <string>

#include "base/math.h"

namespace gatelight::renderer {

/// The background behind the scene, visible directly, through holes, and through panes, which do not refract.
/// Mirrors and glass with an inside show the environment, which lights the scene in any case.
struct BackgroundOptions {
  enum class Kind : std::uint8_t {
    scene,        ///< the environment
    transparent,  ///< nothing: the picture has an alpha
    color,        ///< one radiance
    file,         ///< a picture, scaled to cover the view
  };
  Kind kind = Kind::scene;
  Color color{0.0f, 0.0f, 0.0f};
  std::string file;
  /// Nodes of the scene, separated by ';', whose objects are invisible except for the shadows on them; a '*'
  /// at the end of a name matches any ending. Others may be catchers by themselves (scene/visibility.h).
  std::string shadow_catcher;

  /// Whether the environment is left out of the view.
  bool is_separate() const { return kind != Kind::scene; }

  bool operator==(const BackgroundOptions& other) const {
    return kind == other.kind && (color == other.color).all() && file == other.file &&
           shadow_catcher == other.shadow_catcher;
  }
};

}  // namespace gatelight::renderer
