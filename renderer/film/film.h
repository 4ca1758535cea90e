#pragma once
// Sums samples for each pixel. A pixel belongs to one task at a time and adds its samples in order, so its
// bits do not depend on the number of threads. Sums are double, so that a million samples do not drift.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/film/camera_sample.h"
#include "renderer/image/picture.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

/// The exact sums of a film, pixel after pixel: all samples, then those of both halves where the film keeps
/// them. The `first` members are empty if the film keeps no first hits.
struct FilmState {
  std::vector<double> radiance;
  std::vector<std::uint32_t> radiance_counts;
  std::vector<double> first;
  std::vector<std::uint32_t> first_counts;
  std::vector<float> first_ids;
};

class Film {
 public:
  Film(PixelRect rect, int full_width, int full_height, std::span<const Aov> aovs);

  const PixelRect& rect() const { return rect_; }
  /// Whether some requested output variable comes from the primary hit.
  bool needs_first_hits() const { return !first_.empty(); }

  void add(int x, int y, const Color& radiance);
  void add(int x, int y, const FirstHit& first);

  /// Samples of a pixel so far, those that were dropped among them.
  std::uint32_t taken(int x, int y) const { return radiance_[pixel(x, y)].taken; }
  /// Counts one more. Returns its number.
  std::uint32_t take(int x, int y) { return radiance_[pixel(x, y)].taken++; }

  /// The means so far. A pixel without samples is black.
  Picture resolve() const;

  /// The layer of an output variable. Those of the primary hit need a film that keeps it.
  Layer layer(Aov aov) const;
  /// Mean number of samples of a pixel.
  double samples_per_pixel() const;

  /// CameraSample::faint for a pixel's next sample: a share of its mean so far.
  float faint(int x, int y) const;

  FilmState export_state() const;
  /// The state comes from a film with the same size and output variables.
  void import_state(const FilmState& state);

  static std::size_t bytes_per_pixel(std::span<const Aov> aovs);

 private:
  struct Radiance {
    std::array<double, 3> sum{};
    std::array<double, 3> square{};
    std::uint32_t count = 0;
    std::uint32_t taken = 0;  ///< with those that were dropped; 0 in halves
  };
  struct First {
    std::array<double, 3> albedo{};
    std::array<double, 3> normal{};
    std::array<double, 3> position{};
    std::array<double, 3> cache_radiance{};
    std::array<double, 3> cache_half{};  ///< of cache_radiance: every second one
    std::array<double, 3> answer{};
    std::array<double, 3> node{};
    double depth = 0.0;
    double error = 0.0;
    double training_count = 0.0;
    double resolution = 0.0;
    std::uint32_t count = 0;  ///< number of samples
    std::uint32_t asked = 0;
    std::uint32_t hits = 0;
    std::uint32_t guided = 0;
    float instance = -1.0f;
    float primitive = -1.0f;
  };
  static double mean(const Radiance& p, std::size_t channel);
  /// Unbiased for independent samples, an upper bound for low-discrepancy samples.
  static double variance_of_mean(const Radiance& p, std::size_t channel);
  std::size_t pixel(int x, int y) const {
    return static_cast<std::size_t>(y - rect_.y0) * static_cast<std::size_t>(rect_.width()) +
           static_cast<std::size_t>(x - rect_.x0);
  }
  /// The layers of Aov::reconstruction that are no output variables of their own.
  void add_halves(std::vector<Layer>& layers) const;

  PixelRect rect_;
  int full_width_;
  int full_height_;
  std::vector<Aov> aovs_;
  std::vector<Radiance> radiance_;
  std::array<std::vector<Radiance>, 2> halves_;  ///< samples in turn; empty where nobody asks
  std::vector<First> first_;
};

}  // namespace gatelight::renderer
