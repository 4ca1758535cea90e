#include "renderer/light/environment_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "renderer/sampling/warp.h"

namespace gatelight::renderer {
namespace {

/// u goes to the right from 0 to 1, with 0.5 at -z. v goes down from +y.
Vec2 direction_to_uv(const Vec3& d) {
  return {0.5f + std::atan2(d.x(), -d.z()) * kInvTwoPi,
          // This form is precise at the poles, unlike the arc cosine.
          std::atan2(std::sqrt(d.x() * d.x() + d.z() * d.z()), d.y()) * kInvPi};
}

int clamp_index(float x, int count) {
  return std::clamp(static_cast<int>(x), 0, count - 1);
}

double cosine_at(int row, int height) {
  // This form is symmetric about the equator to the last bit.
  return std::sin(M_PI * (0.5 - static_cast<double>(row) / height));
}

/// Fills `cdf` (one longer than `weights`) and returns the sum. The distribution is uniform if all weights
/// are zero.
double accumulate(std::span<const double> weights, std::span<float> cdf) {
  double sum = 0.0;
  for (const double w : weights) sum += w;
  double running = 0.0;
  cdf[0] = 0.0f;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    running += sum > 0.0 ? weights[i] / sum : 1.0 / static_cast<double>(weights.size());
    cdf[i + 1] = static_cast<float>(std::min(running, 1.0));
  }
  cdf[weights.size()] = 1.0f;
  return sum;
}

struct Choice {
  int index = 0;
  float fraction = 0.0f;  ///< position within the interval, in [0, 1)
};

Choice invert(const float* cdf, int count, float u) {
  // The first interval that ends beyond u. Intervals of width zero are never chosen.
  const float* end = std::upper_bound(cdf + 1, cdf + count, u);
  const int index = static_cast<int>(end - cdf) - 1;
  const float width = cdf[index + 1] - cdf[index];
  return {index, width > 0.0f ? std::min((u - cdf[index]) / width, 0x1.fffffep-1f) : 0.5f};
}

}  // namespace

EnvironmentPicture::EnvironmentPicture(int width, int height, std::vector<Color> texels) {
  levels_.push_back({width, height, std::move(texels)});
  while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(halve(levels_.back()));
  build_density();
}

Color EnvironmentPicture::bilinear(const Level& level, const Vec2& uv) {
  const float x = uv.x() * static_cast<float>(level.width) - 0.5f;
  const float y = std::clamp(uv.y() * static_cast<float>(level.height) - 0.5f, 0.0f,
                             static_cast<float>(level.height - 1));
  const float floor_x = std::floor(x);
  const float tx = x - floor_x;
  int x0 = static_cast<int>(floor_x);
  if (x0 < 0) x0 += level.width;
  if (x0 >= level.width) x0 -= level.width;
  const int x1 = x0 + 1 == level.width ? 0 : x0 + 1;
  const int y0 = static_cast<int>(y);
  const int y1 = std::min(y0 + 1, level.height - 1);
  const float ty = y - static_cast<float>(y0);
  const Color* top = level.texels.data() + static_cast<std::ptrdiff_t>(y0) * level.width;
  const Color* bottom = level.texels.data() + static_cast<std::ptrdiff_t>(y1) * level.width;
  return (1.0f - ty) * ((1.0f - tx) * top[x0] + tx * top[x1]) +
         ty * ((1.0f - tx) * bottom[x0] + tx * bottom[x1]);
}

EnvironmentPicture::Level EnvironmentPicture::halve(const Level& source) {
  // A texel of the coarser level is the mean over the part of the sphere that it covers. If the size is odd,
  // two texels share a source texel.
  Level level{std::max(1, source.width / 2), std::max(1, source.height / 2), {}};
  level.texels.resize(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height));
  const double step_x = static_cast<double>(source.width) / level.width;
  const double step_y = static_cast<double>(source.height) / level.height;
  const auto overlap = [](double low, double high, int cell) {
    return std::max(0.0, std::min(high, cell + 1.0) - std::max(low, static_cast<double>(cell)));
  };
  for (int y = 0; y < level.height; ++y) {
    const double y_low = y * step_y;
    const double y_high = (y + 1) * step_y;
    for (int x = 0; x < level.width; ++x) {
      const double x_low = x * step_x;
      const double x_high = (x + 1) * step_x;
      Eigen::Array3d sum = Eigen::Array3d::Zero();
      double total = 0.0;
      for (int sy = static_cast<int>(y_low); sy < std::min<double>(y_high, source.height); ++sy) {
        const double row =
            overlap(y_low, y_high, sy) * (cosine_at(sy, source.height) - cosine_at(sy + 1, source.height));
        for (int sx = static_cast<int>(x_low); sx < std::min<double>(x_high, source.width); ++sx) {
          const double weight = row * overlap(x_low, x_high, sx);
          const std::size_t index = static_cast<std::size_t>(sy) * static_cast<std::size_t>(source.width) +
                                    static_cast<std::size_t>(sx);
          sum += weight * source.texels[index].cast<double>();
          total += weight;
        }
      }
      level.texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) +
                   static_cast<std::size_t>(x)] = (sum / total).cast<float>();
    }
  }
  return level;
}

void EnvironmentPicture::build_density() {
  const Level& finest = levels_.front();
  const auto width = static_cast<std::size_t>(finest.width);
  const auto height = static_cast<std::size_t>(finest.height);
  row_cosines_.resize(height + 1);
  for (std::size_t y = 0; y <= height; ++y) {
    row_cosines_[y] = static_cast<float>(cosine_at(static_cast<int>(y), finest.height));
  }
  row_cdf_.resize(height + 1);
  column_cdf_.resize(height * (width + 1));
  density_.resize(width * height);

  std::vector<double> rows(height);
  std::vector<double> columns(width);
  std::vector<double> blurred(width);
  Eigen::Array3d mean = Eigen::Array3d::Zero();
  for (std::size_t y = 0; y < height; ++y) {
    const double cell =
        (cosine_at(static_cast<int>(y), finest.height) - cosine_at(static_cast<int>(y) + 1, finest.height)) *
        2.0 * M_PI / static_cast<double>(width);
    const Color* middle = finest.texels.data() + y * width;
    const Color* above = y > 0 ? middle - width : middle;
    const Color* below = y + 1 < height ? middle + width : middle;
    Eigen::Array3d row_sum = Eigen::Array3d::Zero();
    for (std::size_t x = 0; x < width; ++x) {
      const Eigen::Array3d value =
          0.75 * middle[x].cast<double>() + 0.125 * (above[x].cast<double>() + below[x].cast<double>());
      row_sum += value;
      blurred[x] = 0.2126 * value.x() + 0.7152 * value.y() + 0.0722 * value.z();
    }
    mean += row_sum * cell / (4.0 * M_PI);
    for (std::size_t x = 0; x < width; ++x) {
      const double left = blurred[x > 0 ? x - 1 : width - 1];
      const double right = blurred[x + 1 < width ? x + 1 : 0];
      columns[x] = (0.75 * blurred[x] + 0.125 * (left + right)) * cell;
    }
    rows[y] = accumulate(columns, std::span(column_cdf_).subspan(y * (width + 1), width + 1));
    // This is the weight. The loop below divides it by the sum.
    for (std::size_t x = 0; x < width; ++x) density_[y * width + x] = static_cast<float>(columns[x] / cell);
  }
  mean_ = mean.cast<float>();
  const double sum = accumulate(rows, row_cdf_);
  for (float& d : density_) d = sum > 0.0 ? static_cast<float>(static_cast<double>(d) / sum) : 0.0f;
}

Color EnvironmentPicture::radiance(const Vec3& direction, float cone_angle) const {
  const Vec2 uv = direction_to_uv(direction);
  const float texels = cone_angle * static_cast<float>(levels_.front().height) * kInvPi;
  if (!(texels > 1.0f)) return bilinear(levels_.front(), uv);
  const float level = std::min(std::log2(texels), static_cast<float>(levels_.size() - 1));
  const auto fine = static_cast<std::size_t>(level);
  const std::size_t coarse = std::min(fine + 1, levels_.size() - 1);
  const float t = level - static_cast<float>(fine);
  return (1.0f - t) * bilinear(levels_[fine], uv) + t * bilinear(levels_[coarse], uv);
}

EnvironmentSample EnvironmentPicture::sample(const Vec2& u) const {
  const Level& finest = levels_.front();
  const Choice row = invert(row_cdf_.data(), finest.height, u.y());
  const auto y = static_cast<std::size_t>(row.index);
  const auto width = static_cast<std::size_t>(finest.width);
  const Choice column = invert(column_cdf_.data() + y * (width + 1), finest.width, u.x());
  EnvironmentSample sample;
  sample.pdf = density_[y * width + static_cast<std::size_t>(column.index)];
  if (!(sample.pdf > 0.0f)) return {};

  const float cos_theta = row_cosines_[y] + row.fraction * (row_cosines_[y + 1] - row_cosines_[y]);
  const float sin_theta = std::sqrt(std::max(0.0f, (1.0f - cos_theta) * (1.0f + cos_theta)));
  const float turn = (static_cast<float>(column.index) + column.fraction) / static_cast<float>(finest.width);
  // A turn of 0 is +z, at the left edge. The centre is -z, and +x is to its right.
  const Vec2 cs = cos_sin_turn(turn);
  sample.wi = Vec3(-sin_theta * cs.y(), cos_theta, sin_theta * cs.x());
  sample.radiance = radiance(sample.wi);
  return sample;
}

float EnvironmentPicture::pdf(const Vec3& direction) const {
  const Level& finest = levels_.front();
  const Vec2 uv = direction_to_uv(direction);
  const auto x =
      static_cast<std::size_t>(clamp_index(uv.x() * static_cast<float>(finest.width), finest.width));
  const auto y =
      static_cast<std::size_t>(clamp_index(uv.y() * static_cast<float>(finest.height), finest.height));
  return density_[y * static_cast<std::size_t>(finest.width) + x];
}

std::size_t EnvironmentPicture::bytes() const {
  std::size_t total =
      sizeof(float) * (row_cosines_.size() + row_cdf_.size() + column_cdf_.size() + density_.size());
  for (const Level& level : levels_) total += sizeof(Color) * level.texels.size();
  return total;
}

}  // namespace gatelight::renderer
