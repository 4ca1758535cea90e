#pragma once
// Pictures of one scene with different seeds into one with less noise.

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/metrics/beauty.h"

namespace gatelight::renderer {

/// The mean of the pictures, weighted by their samples per pixel (metadata "spp") where they tell them, by
/// the same weight where none does. One at a time, so that many need no more memory than two.
///
/// Layers are averaged, but "samples" is the sum, "variance" that of the mean, and "primitive" and
/// "instance", of which there is no mean, are the first picture's. Of the metadata remains what all have in
/// common; "spp" is the sum, "seed" the list.
class PictureMerger {
 public:
  /// Throws CompareError where size, place or layers are not those of the first, where some tell their spp
  /// and others do not, where their sum leaves 64 bits, or where they tell of different integrators.
  void add(const NamedPicture& named);

  /// At least one was added. All layers in full precision.
  Picture finish() const;

 private:
  void start(const NamedPicture& named);
  void require_same_shape(const NamedPicture& named) const;
  void merge_metadata(const Picture& picture);

  Picture merged_;  ///< all but the values that are summed
  std::string first_name_;
  std::vector<std::vector<double>> sums_;  ///< of each layer
  bool weighted_ = false;
  double weight_ = 0.0;
  std::uint64_t spp_ = 0;
};

/// Of all of them at once.
Picture merge_pictures(const std::vector<NamedPicture>& pictures);

}  // namespace gatelight::renderer
