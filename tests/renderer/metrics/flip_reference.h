#pragma once
// LDR-FLIP written down from the paper: double precision, every filter a whole 2D convolution, one pixel at a
// time. Shares nothing with renderer/flip but the constants of the tables.

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace gatelight::renderer::reference {

using std::numbers::pi;
using Color = std::array<double, 3>;

struct Image {
  int width = 0;
  int height = 0;
  std::vector<Color> pixels;

  /// The nearest pixel of the picture.
  const Color& at(int x, int y) const {
    x = x < 0 ? 0 : x >= width ? width - 1 : x;
    y = y < 0 ? 0 : y >= height ? height - 1 : y;
    return pixels[static_cast<std::size_t>(y * width + x)];
  }
};

inline constexpr Color kWhite{0.9504285453771807, 1.0, 1.0889003707981277};
inline constexpr std::array<Color, 3> kToXyz{
    {{0.41238656325299233, 0.3575914909206254, 0.18045049120356298},
     {0.21263682167732384, 0.7151829818412507, 0.07218019648142519},
     {0.01933062015248383, 0.11919716364020842, 0.9503725870054354}}};
/// Its inverse, rounded as the paper's supplement prints it.
inline constexpr std::array<Color, 3> kFromXyz{{{3.241003275, -1.537398934, -0.498615861},
                                                {-0.969224334, 1.875930071, 0.041554224},
                                                {0.055639423, -0.204011202, 1.057148933}}};

inline Color transform(const std::array<Color, 3>& m, const Color& v) {
  Color out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
  return out;
}

inline Color ycxcz(const Color& rgb) {
  const Color xyz = transform(kToXyz, rgb);
  const double x = xyz[0] / kWhite[0], y = xyz[1] / kWhite[1], z = xyz[2] / kWhite[2];
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

inline Color unit_rgb(const Color& c) {
  const double y = (c[0] + 16.0) / 116.0;
  Color rgb =
      transform(kFromXyz, {(y + c[1] / 500.0) * kWhite[0], y * kWhite[1], (y - c[2] / 200.0) * kWhite[2]});
  for (double& v : rgb) v = v < 0.0 ? 0.0 : v > 1.0 ? 1.0 : v;
  return rgb;
}

inline Color hunt_lab(const Color& rgb) {
  const Color xyz = transform(kToXyz, rgb);
  Color f{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double t = xyz[i] / kWhite[i];
    f[i] = t > 216.0 / 24389.0 ? std::cbrt(t) : t * 841.0 / 108.0 + 4.0 / 29.0;
  }
  const double lightness = 116.0 * f[1] - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (f[0] - f[1]), 0.01 * lightness * 200.0 * (f[1] - f[2])};
}

inline double hyab(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

/// weight(x, y) of the pixels from -radius to radius.
struct Filter {
  int radius = 0;
  std::vector<double> weights;

  Filter(int r, const std::function<double(int, int)>& weight) : radius(r) {
    for (int y = -r; y <= r; ++y) {
      for (int x = -r; x <= r; ++x) weights.push_back(weight(x, y));
    }
  }
  /// Positive weights sum up to 1, negative ones to -1.
  void normalize() {
    double positive = 0.0, negative = 0.0;
    for (double w : weights) (w > 0.0 ? positive : negative) += std::abs(w);
    for (double& w : weights) w /= w > 0.0 ? positive : negative > 0.0 ? negative : 1.0;
  }
  double apply(const Image& image, std::size_t channel, int px, int py) const {
    double sum = 0.0;
    std::size_t i = 0;
    for (int y = -radius; y <= radius; ++y) {
      for (int x = -radius; x <= radius; ++x) sum += weights[i++] * image.at(px + x, py + y)[channel];
    }
    return sum;
  }
};

inline std::vector<double> ldr_flip(const Image& reference, const Image& test, double ppd) {
  const auto gaussian = [&](double a, double b, int x, int y) {
    const double d2 = (x * x + y * y) / (ppd * ppd);
    return a * std::sqrt(pi / b) * std::exp(-pi * pi * d2 / b);
  };
  const int radius = static_cast<int>(std::ceil(3.0 * std::sqrt(0.04 / (2.0 * pi * pi)) * ppd));
  std::array<Filter, 3> spatial{
      Filter(radius, [&](int x, int y) { return gaussian(1.0, 0.0047, x, y); }),
      Filter(radius, [&](int x, int y) { return gaussian(1.0, 0.0053, x, y); }),
      Filter(radius, [&](int x, int y) { return gaussian(34.1, 0.04, x, y) + gaussian(13.5, 0.025, x, y); })};
  for (Filter& filter : spatial) filter.normalize();
  const double sigma = 0.5 * 0.082 * ppd;
  const int feature_radius = static_cast<int>(std::ceil(3.0 * sigma));
  const auto g = [&](int x, int y) { return std::exp(-(x * x + y * y) / (2.0 * sigma * sigma)); };
  std::array<Filter, 4> features{
      Filter(feature_radius, [&](int x, int y) { return -x * g(x, y); }),
      Filter(feature_radius, [&](int x, int y) { return -y * g(x, y); }),
      Filter(feature_radius, [&](int x, int y) { return (x * x / (sigma * sigma) - 1.0) * g(x, y); }),
      Filter(feature_radius, [&](int x, int y) { return (y * y / (sigma * sigma) - 1.0) * g(x, y); })};
  for (Filter& filter : features) filter.normalize();

  const auto opponent = [](const Image& image) {
    Image out = image;
    for (Color& c : out.pixels) c = ycxcz(c);
    return out;
  };
  const std::array<Image, 2> images{opponent(reference), opponent(test)};
  const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
  std::vector<double> errors;
  for (int y = 0; y < reference.height; ++y) {
    for (int x = 0; x < reference.width; ++x) {
      std::array<Color, 2> seen{};
      std::array<double, 2> edge{}, point{};
      for (std::size_t i = 0; i < 2; ++i) {
        const auto& image = images[i];
        seen[i] = hunt_lab(unit_rgb({spatial[0].apply(image, 0, x, y), spatial[1].apply(image, 1, x, y),
                                     spatial[2].apply(image, 2, x, y)}));
        // The features are of (Y + 16) / 116: the 16 falls out, the weights sum up to 0.
        edge[i] = std::hypot(features[0].apply(image, 0, x, y), features[1].apply(image, 0, x, y)) / 116.0;
        point[i] = std::hypot(features[2].apply(image, 0, x, y), features[3].apply(image, 0, x, y)) / 116.0;
      }
      const double difference = std::pow(hyab(seen[0], seen[1]), 0.7);
      const double knee = 0.4 * largest;
      const double color =
          difference < knee ? 0.95 / knee * difference : 0.95 + (difference - knee) / (largest - knee) * 0.05;
      const double feature = std::sqrt(std::max(std::abs(edge[0] - edge[1]), std::abs(point[0] - point[1])) /
                                       std::numbers::sqrt2);
      errors.push_back(std::pow(color, 1.0 - feature));
    }
  }
  return errors;
}

}  // namespace gatelight::renderer::reference
