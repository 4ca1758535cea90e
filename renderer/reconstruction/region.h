#pragma once
// Some rows of a picture on their way from samples to the finished picture.

#include <array>

#include "renderer/reconstruction/outliers.h"
#include "renderer/reconstruction/sampled_picture.h"

namespace gatelight::renderer {

/// The rows that a finished row depends on, in each direction: outliers, windows, their patches, and the
/// smoothing of errors. A multiple of the windows' stride.
inline constexpr int kHalo = 64;

class Region {
 public:
  /// The rows first <= y < end of a picture, of which `samples` are those from `top` on. `first` is a
  /// multiple of the windows' stride. `scale` is a usual brightness; the methods' small numbers are relative
  /// to it.
  Region(const SampledPicture& samples, int top, int first, int end, float scale);

  /// Fits both halves in all windows that decide the rows from_row <= y < to_row.
  void fit(const ReconstructionKernels& kernels, int from_row, int to_row);
  /// Joins the fits with the samples' mean by their estimated errors.
  void join();
  /// Where a row of each goes, 3 floats a pixel, of noise one.
  struct Row {
    float* color;
    float* error;
    float* halves[2];
    float* noise[2];
  };
  void write_row(int y, Row to) const;
  /// Sums over a row of the samples, relative to each other: what stays and what is lost with outliers. A row
  /// may get more than it gives.
  std::array<double, 2> light_of_row(int y) const;

 private:
  struct Half : HalfPlanes {
    Plane fit[3];
    Plane influence;  ///< of a pixel's own samples on its fit
  };

  void read(const SampledPicture& samples, int top);
  void complete_variance();
  void fill_gaps();
  Plane smooth_variance(const Half& half) const;
  Plane cache_variance() const;
  Plane edge_noise() const;

  std::size_t pixels() const { return static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_); }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_;
  int height_;
  int first_;
  float scale_;
  Half halves_[2];
  Plane lost_;  ///< light that outliers gave less what the pixel got
  Plane counts_;
  Plane coverage_;
  Plane divisor_[3];  ///< of colours: what the surface reflects
  Plane normal_[3];
  Plane depth_;
  Plane cache_[2][3];  ///< the cache's picture over the divisor, for the fit of each half; empty without one
  Plane cache_noise_;  ///< squared, of a channel's mean
  Plane color_[3];     ///< finished
  Plane error_;        ///< squared, of a channel's mean
};

}  // namespace gatelight::renderer
