#include "renderer/driver/background.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/image/color_channels.h"
#include "renderer/image/image_library.h"
#include "renderer/image/image_read.h"

namespace gatelight::renderer {
namespace {

std::size_t size(int x) {
  return static_cast<std::size_t>(x);
}

/// Replaces values that are not finite: they would spread into the pixels around, and show through opaque
/// pixels.
float repaired(float value) {
  constexpr float kGreatest = 65504.0f;  // half precision stores anything larger as infinity
  if (std::isfinite(value)) return value;
  return value > 0.0f ? kGreatest : 0.0f;
}

/// Three values a pixel of the full picture: the middle of a file's picture, as much of it as covers the
/// view.
std::vector<float> read_cover(const std::string& file, int width, int height) {
  const Picture source = read_image(file);
  const Layer& layer = source.layers.front();
  const auto channels = color_channels(layer);
  if (!channels)
    throw InputError(
        fmt::format("cannot use '{}' as a background: it has the {}", file, describe_channels(layer)));
  const double scale =
      std::min(static_cast<double>(source.width) / width, static_cast<double>(source.height) / height);
  const int columns = std::clamp(static_cast<int>(std::lround(scale * width)), 1, source.width);
  const int rows = std::clamp(static_cast<int>(std::lround(scale * height)), 1, source.height);
  const int left = (source.width - columns) / 2, top = (source.height - rows) / 2;
  std::vector<float> middle;
  middle.reserve(3 * size(columns) * size(rows));
  for (int y = top; y < top + rows; ++y) {
    for (int x = left; x < left + columns; ++x) {
      const std::size_t at = (size(y) * size(source.width) + size(x)) * layer.channels.size();
      for (const std::size_t c : *channels) middle.push_back(repaired(layer.values[at + c]));
    }
  }
  if (columns == width && rows == height) return middle;
  return image_library().resize(middle, columns, rows, width, height);
}

}  // namespace

void check_background(const BackgroundOptions& background, int width, int height) {
  if (background.kind == BackgroundOptions::Kind::file) read_cover(background.file, width, height);
}

void put_before(Picture& picture, const std::vector<float>& alpha, const BackgroundOptions& background) {
  using Kind = BackgroundOptions::Kind;
  Layer& beauty = picture.layers.front();
  if (background.kind == Kind::transparent) {
    std::vector<float> values;
    values.reserve(4 * alpha.size());
    for (std::size_t p = 0; p < alpha.size(); ++p) {
      values.insert(values.end(), &beauty.values[3 * p], &beauty.values[3 * p] + 3);
      values.push_back(std::clamp(alpha[p], 0.0f, 1.0f));
    }
    beauty.values = std::move(values);
    beauty.channels.push_back("A");
    return;
  }
  const int width = picture.full_width > 0 ? picture.full_width : picture.width;
  const int height = picture.full_height > 0 ? picture.full_height : picture.height;
  std::vector<float> cover;
  if (background.kind == Kind::file) {
    if (picture.x0 < 0 || picture.y0 < 0 || picture.x0 + picture.width > width ||
        picture.y0 + picture.height > height) {
      throw InputError(fmt::format(
          "cannot put '{}' behind the pixels {},{} to {},{}: expected them within {}x{}", background.file,
          picture.x0, picture.y0, picture.x0 + picture.width, picture.y0 + picture.height, width, height));
    }
    cover = read_cover(background.file, width, height);
  }
  for (std::size_t p = 0; p < alpha.size(); ++p) {
    const std::size_t x = p % size(picture.width) + size(picture.x0),
                      y = p / size(picture.width) + size(picture.y0);
    for (std::size_t c = 0; c < 3; ++c) {
      const float behind = cover.empty() ? background.color[static_cast<Eigen::Index>(c)]
                                         : cover[3 * (y * size(width) + x) + c];
      beauty.values[3 * p + c] += std::clamp(1.0f - alpha[p], 0.0f, 1.0f) * behind;
    }
  }
}

}  // namespace gatelight::renderer
