#pragma once
// Reads the colours of a picture's beauty layer, in any order of its channels.

#include <array>
#include <cmath>
#include <cstddef>
#include <string>

#include "base/errors.h"
#include "renderer/image/picture.h"

namespace gatelight::renderer {

struct NamedPicture {
  const Picture& picture;
  std::string name;  ///< for messages
};

using Rgb = std::array<double, 3>;

class Beauty {
 public:
  /// A layer of one channel is grey. Throws InputError without a beauty layer. The picture must outlive
  /// this object.
  explicit Beauty(const NamedPicture& named);

  bool is_grey() const { return index_[0] == index_[1]; }
  Rgb at(std::size_t pixel) const {
    const float* values = layer_->values.data() + pixel * layer_->channels.size();
    return {values[index_[0]], values[index_[1]], values[index_[2]]};
  }

 private:
  const Layer* layer_ = nullptr;
  std::array<std::size_t, 3> index_{};
};

inline bool finite(const Rgb& color) {
  return std::isfinite(color[0]) && std::isfinite(color[1]) && std::isfinite(color[2]);
}

inline std::size_t pixel_count(const Picture& picture) {
  return static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
}

/// Throws InputError when the sizes differ, when the regions of full pictures of one size differ, when one
/// picture is grey and the other has colours, or when a beauty layer is missing.
void require_comparable(const NamedPicture& a, const NamedPicture& b);

/// All that require_comparable() uses of a picture: a later one can be compared with it, at no cost of
/// memory.
Picture without_values(const Picture& picture);

}  // namespace gatelight::renderer
