#include "renderer/sampling/wavelength.h"

#include <array>

#include "renderer/sampling/color_matching.h"

namespace gatelight::renderer {
namespace {

constexpr double kFirst = 390.0, kStep = 2.0;  // nanometres
constexpr std::size_t kSteps = 160;

struct Table {
  std::array<Color, kSteps> colors;
  std::array<float, kSteps + 1> cdf{};

  Table() {
    std::array<Eigen::Array3d, kSteps> rgb;
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (std::size_t i = 0; i < kSteps; ++i) {
      const double nm = kFirst + kStep * (static_cast<double>(i) + 0.5);
      rgb[i] = (rec709_from_xyz() * color_matching(nm)).array().max(0.0);
      sum += rgb[i];
    }
    double below = 0.0;
    for (std::size_t i = 0; i < kSteps; ++i) {
      const Eigen::Array3d share = rgb[i] / sum;
      const double chance = share.sum() / 3.0;
      colors[i] = (chance > 0.0 ? Eigen::Array3d(share / chance) : Eigen::Array3d::Ones()).cast<float>();
      below += chance;
      cdf[i + 1] = static_cast<float>(std::min(below, 1.0));
    }
    cdf[kSteps] = 1.0f;
  }
};

}  // namespace

Wavelength sample_wavelength(float u) {
  static const Table table;
  // The first step that ends beyond u. Steps without a share are never chosen.
  const auto end = std::upper_bound(table.cdf.begin() + 1, table.cdf.end() - 1, u);
  const auto i = static_cast<std::size_t>(end - table.cdf.begin()) - 1;
  const float width = table.cdf[i + 1] - table.cdf[i];
  const float within = width > 0.0f ? (u - table.cdf[i]) / width : 0.5f;
  return {static_cast<float>(kFirst) + static_cast<float>(kStep) * (static_cast<float>(i) + within),
          table.colors[i]};
}

}  // namespace gatelight::renderer
