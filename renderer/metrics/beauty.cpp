#include "renderer/metrics/beauty.h"

#include <fmt/format.h>

#include "renderer/image/color_channels.h"

namespace gatelight::renderer {
namespace {

struct Place {
  int x0, y0, width, height;  ///< width and height of the full picture
};

Place place(const Picture& picture) {
  const bool whole = picture.full_width <= 0;
  return {picture.x0, picture.y0, whole ? picture.width : picture.full_width,
          whole ? picture.height : picture.full_height};
}

}  // namespace

Beauty::Beauty(const NamedPicture& named) {
  if (named.picture.layers.empty() || named.picture.layers.front().channels.empty()) {
    throw InputError(fmt::format("'{}' has no layer to compare", named.name));
  }
  layer_ = &named.picture.layers.front();
  const auto index = color_channels(*layer_);
  if (!index) {
    throw InputError(
        fmt::format("'{}' has no beauty layer: it has the {}", named.name, describe_channels(*layer_)));
  }
  index_ = *index;
}

void require_comparable(const NamedPicture& a, const NamedPicture& b) {
  if (a.picture.width != b.picture.width || a.picture.height != b.picture.height) {
    throw InputError(fmt::format("the pictures differ in size: '{}' has {}x{} pixels, '{}' has {}x{}", a.name,
                                 a.picture.width, a.picture.height, b.name, b.picture.width,
                                 b.picture.height));
  }
  // The places are compared only for full pictures of one size. Otherwise one file may hold only the part
  // that the other shows.
  const Place at = place(a.picture), other = place(b.picture);
  if (at.width == other.width && at.height == other.height && (at.x0 != other.x0 || at.y0 != other.y0)) {
    throw InputError(fmt::format(
        "the pictures show different regions of {}x{} pixels: '{}' begins at {},{}, '{}' at {},{}", at.width,
        at.height, a.name, at.x0, at.y0, b.name, other.x0, other.y0));
  }
  const bool grey = Beauty(a).is_grey();
  if (grey != Beauty(b).is_grey()) {
    throw InputError(fmt::format("the pictures differ in channels: '{}' is grey, '{}' has colours",
                                 grey ? a.name : b.name, grey ? b.name : a.name));
  }
}

Picture without_values(const Picture& picture) {
  Picture shape{.width = picture.width,
                .height = picture.height,
                .x0 = picture.x0,
                .y0 = picture.y0,
                .full_width = picture.full_width,
                .full_height = picture.full_height};
  if (!picture.layers.empty()) {
    const Layer& beauty = picture.layers.front();
    shape.layers.push_back({.name = beauty.name, .channels = beauty.channels});
  }
  return shape;
}

}  // namespace gatelight::renderer
