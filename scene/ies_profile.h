#pragma once
// Photometric measurements of luminaires: IES files (ANSI/IES LM-63, type C).

#include <filesystem>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace gatelight::scene {

/// Intensities in all directions, in the frame of the light: it aims along -z, and horizontal angles turn
/// from x to y, as in the extension EXT_lights_ies.
class IesProfile {
 public:
  /// Parses the text of a file. Throws InputError; its message does not contain the file's name.
  explicit IesProfile(std::string_view text);

  /// The intensity in a direction of any length, relative to the greatest intensity. Interpolated linearly
  /// between angles; 0 outside the measured ones.
  float relative(const Vec3& direction) const;
  /// The greatest intensity in candela.
  double greatest() const { return greatest_; }
  /// The greatest angle from the axis with light, in radians.
  float extent() const { return extent_; }
  /// relative() every 0.25 degrees from the axis and every 2.5 degrees around it, which includes the angles
  /// of typical files. Row-major; one column if the profile is rotationally symmetric.
  const std::vector<float>& values() const { return values_; }

 private:
  std::vector<float> values_;
  std::size_t columns_ = 1;
  double greatest_ = 0.0;
  float extent_ = 0.0f;
};

/// Throws InputError; its message names the file.
IesProfile read_ies_profile(const std::filesystem::path& path);

}  // namespace gatelight::scene
