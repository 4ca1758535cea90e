#pragma once
// The colours of a picture's beauty layer, whatever the order of its channels.

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Pictures that cannot be compared. The message names both.
struct CompareError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct NamedPicture {
  const Picture& picture;
  std::string name;  ///< for messages
};

using Rgb = std::array<double, 3>;

class Beauty {
 public:
  /// A layer of one channel is grey. Throws CompareError where there is no beauty layer. The picture must
  /// outlive this.
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

/// Throws CompareError for different sizes, for different regions of a full picture of one size, for one grey
/// and one colour, and without a beauty layer.
void require_comparable(const NamedPicture& a, const NamedPicture& b);

}  // namespace gatelight::renderer
