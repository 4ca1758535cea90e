#include "renderer/beauty.h"

#include <fmt/format.h>

#include <algorithm>

namespace gatelight::renderer {

Beauty::Beauty(const NamedPicture& named) {
  if (named.picture.layers.empty() || named.picture.layers.front().channels.empty()) {
    throw CompareError(fmt::format("'{}' has no layer to compare", named.name));
  }
  layer_ = &named.picture.layers.front();
  const std::vector<std::string>& channels = layer_->channels;
  const std::array<const char*, 3> names{"R", "G", "B"};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto found = std::find(channels.begin(), channels.end(), names[c]);
    if (found != channels.end()) {
      index_[c] = static_cast<std::size_t>(found - channels.begin());
    } else if (channels.front() == "Y") {
      index_[c] = 0;
    } else {
      throw CompareError(
          fmt::format("'{}' has no beauty layer: channel {} is missing", named.name, names[c]));
    }
  }
}

void require_comparable(const NamedPicture& a, const NamedPicture& b) {
  if (a.picture.width != b.picture.width || a.picture.height != b.picture.height) {
    throw CompareError(fmt::format("the pictures differ in size: '{}' has {}x{} pixels, '{}' has {}x{}",
                                   a.name, a.picture.width, a.picture.height, b.name, b.picture.width,
                                   b.picture.height));
  }
  const bool grey = Beauty(a).is_grey();
  if (grey != Beauty(b).is_grey()) {
    throw CompareError(fmt::format("the pictures differ in channels: '{}' is grey, '{}' has colours",
                                   grey ? a.name : b.name, grey ? b.name : a.name));
  }
}

}  // namespace gatelight::renderer
