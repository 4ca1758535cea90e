#pragma once

#include <optional>
#include <string>

#include "base/math.h"
#include "renderer/settings/sky_options.h"

namespace gatelight::renderer {

/// Homogeneous fog in the bounds of the scene, outside of its bodies.
struct FogOptions {
  float density = 0.0f;            ///< extinction per metre
  Color albedo{1.0f, 1.0f, 1.0f};  ///< the part of the extinction that is scattering
  float anisotropy = 0.0f;         ///< mean cosine of scattering, in (-1, 1): positive forward

  bool operator==(const FogOptions& other) const {
    return density == other.density && (albedo == other.albedo).all() && anisotropy == other.anisotropy;
  }
};

struct EnvironmentOptions {
  /// Adds a soft sky (light/soft_sky.h) if the scene would be dark without it. File, constant and sky are
  /// then not set.
  bool automatic = false;
  std::string file;                  ///< EXR or HDR picture, latitude-longitude; empty: constant
  Color constant{0.0f, 0.0f, 0.0f};  ///< radiance, if there is no file
  std::optional<SkyOptions> sky;     ///< a clear sky with a sun; file and constant are then not set
  float rotation_degrees = 0.0f;     ///< about +y, counter-clockwise seen from above
  float scale = 1.0f;
  std::optional<FogOptions> fog;

  bool none() const { return !automatic && !sky && file.empty() && (constant == 0.0f).all(); }

  bool operator==(const EnvironmentOptions& other) const {
    return automatic == other.automatic && file == other.file && (constant == other.constant).all() &&
           sky == other.sky && rotation_degrees == other.rotation_degrees && scale == other.scale &&
           fog == other.fog;
  }
};

}  // namespace gatelight::renderer
