#pragma once
// Merges pictures of one scene with different seeds into one picture with less noise.

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/metrics/beauty.h"

namespace gatelight::renderer {

/// Computes the mean of pictures, weighted by their samples per pixel (metadata "spp"). Pictures without this
/// entry have equal weights. Pictures are added one at a time, so that many need no more memory than two.
///
/// Layers are averaged, except a few. "samples" is the sum; "variance", "variance-a", "variance-b" and
/// "error" are those of the mean; "primitive", "instance" and Cryptomattes are those of the first picture.
/// The metadata keeps the entries that are equal in all pictures; "spp" is the sum, "seed" the list of all
/// seeds.
class PictureMerger {
 public:
  /// Throws InputError when size, place, layers or integrator differ from the first picture. Also throws
  /// when only some pictures have an "spp", or when their sum exceeds 64 bits.
  void add(const NamedPicture& named);

  /// The merged picture; at least one was added. All layers have full precision.
  Picture finish() const;

 private:
  void start(const NamedPicture& named);
  void require_same_shape(const NamedPicture& named) const;
  void merge_metadata(const Picture& picture);

  Picture merged_;  ///< everything except the values that are summed
  std::string first_name_;
  std::vector<std::vector<double>> sums_;  ///< one for each layer
  bool weighted_ = false;
  double weight_ = 0.0;
  std::uint64_t spp_ = 0;
};

/// Merges all pictures at once.
Picture merge_pictures(const std::vector<NamedPicture>& pictures);

}  // namespace gatelight::renderer
