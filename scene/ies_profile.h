#pragma once
// Light measured around a luminaire: files of the IES (ANSI/IES LM-63, type C photometry).

#include <filesystem>
#include <string_view>
#include <vector>

#include "base/math.h"

namespace gatelight::scene {

/// Intensities in all directions, in the frame of the light: it aims along -z, and horizontal angles turn
/// from x to y, as in the extension EXT_lights_ies.
class IesProfile {
 public:
  /// The text of a file. Throws InputError that says what is wrong, without the file's name.
  explicit IesProfile(std::string_view text);

  /// The intensity in a direction, which need not be unit, as a share of the greatest. Linear between angles;
  /// 0 beyond the measured ones.
  float relative(const Vec3& direction) const;
  /// In candela.
  double greatest() const { return greatest_; }
  /// The greatest angle to the aim at which there is light, in radians.
  float extent() const { return extent_; }
  /// relative() at steps of a quarter of a degree from the aim and of 2.5 degrees around it, which hold the
  /// angles of usual files. Row after row; one column where it is the same all around.
  const std::vector<float>& values() const { return values_; }

 private:
  std::vector<float> values_;
  std::size_t columns_ = 1;
  double greatest_ = 0.0;
  float extent_ = 0.0f;
};

/// Throws InputError that names the file.
IesProfile read_ies_profile(const std::filesystem::path& path);

}  // namespace gatelight::scene
