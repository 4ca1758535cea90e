#pragma once
// Sums samples for each pixel. A pixel belongs to one task at a time and adds its samples in order, so its
// bits do not depend on the number of threads. Sums are double, so that a million samples do not drift.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/film/camera_sample.h"
#include "renderer/film/tiles.h"
#include "renderer/image/picture.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/ranks/packing.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

/// The exact sums of a film, pixel after pixel. Members are empty where the film does not keep them.
struct FilmState {
  std::vector<double> radiance;
  std::vector<std::uint32_t> radiance_counts;
  std::vector<double> half;
  std::vector<std::uint32_t> half_counts;
  std::vector<float> guides;
  std::vector<double> alpha;
  std::vector<double> first;
  std::vector<std::uint32_t> first_counts;
  std::vector<float> first_ids;
  std::vector<double> parts;  ///< of groups of lights
};

/// What a film keeps beside the sums of its samples.
struct FilmContents {
  std::vector<Aov> aovs;                  ///< layers of resolve()
  bool half = false;                      ///< the mean of every other sample
  bool guides = false;                    ///< albedo and normal behind mirrors and clear glass
  bool alpha = false;                     ///< 1 less what of the background is seen
  std::vector<std::string> light_groups;  ///< names of groups, whose parts it keeps
};

/// What these options need. A denoiser that is not chosen yet counts as one.
FilmContents film_contents(const RenderOptions& options, std::vector<std::string> light_groups = {});

/// Planes of a film that are no layers of resolve().
enum class Plane : std::uint8_t {
  mean,    ///< 3 floats a pixel
  half_a,  ///< the same of the samples with even numbers
  half_b,  ///< of those with odd numbers
  albedo,  ///< of the guides, 3 floats
  normal,  ///< the same
  alpha,   ///< 1 float
};

/// The layers of groups of lights begin with it.
inline constexpr const char* kLightLayer = "light-";

class Film {
 public:
  Film(PixelRect rect, int full_width, int full_height, FilmContents contents);

  const PixelRect& rect() const { return rect_; }
  std::size_t pixels() const { return radiance_.size(); }
  /// Whether it keeps anything of primary hits.
  bool needs_first_hits() const { return !guides_.empty() || !alpha_.empty() || !first_.empty(); }
  const std::vector<std::string>& light_groups() const { return contents_.light_groups; }

  /// Samples of a pixel so far, those that were dropped among them.
  std::uint32_t taken(const Pixel& p) const { return radiance_[at(p)].taken; }
  /// Of these, the samples that count.
  std::uint32_t count(const Pixel& p) const { return radiance_[at(p)].count; }
  /// Counts the pixel's next sample.
  PixelSample take(const Pixel& p) { return {p, radiance_[at(p)].taken++}; }
  /// The same for each pixel. Replaces `samples`.
  void take(std::span<const Pixel> pixels, std::vector<PixelSample>& samples);

  /// Of samples that were taken, in the order of their numbers.
  void add(const PixelSample& sample, const Color& radiance);
  void add(const PixelSample& sample, const FirstHit& first);
  /// What each group of lights gives a sample that was added, times `scale`.
  void add_parts(const Pixel& p, std::span<const Color> parts, float scale);

  /// The means so far, and the layers of the output variables but Aov::denoising. A pixel without samples is
  /// black. Runs in the caller's arena.
  Picture resolve() const { return resolve(rect_.y0, rect_.y1); }
  /// The same of the rows first <= y < end.
  Picture resolve(int first, int end) const;

  /// A plane of the rows first <= y < end. The film must keep it. A pixel without samples is 0, and one
  /// without samples of a half has the mean of all. Runs in the caller's arena.
  std::vector<float> plane(Plane plane, int first, int end) const;
  /// The layer of an output variable. Those of the primary hit need a film that keeps it.
  Layer layer(Aov aov) const { return layer(aov, {0, pixels()}); }
  /// Mean number of samples of a pixel that count.
  double samples_per_pixel() const;

  /// CameraSample::faint for a pixel's next sample: a share of its mean so far.
  float faint(const Pixel& p) const;

  FilmState export_state() const;
  /// The state comes from a film with the same size and output variables.
  void import_state(const FilmState& state);

  /// The exact sums of some pixels, for a film of the same kind in another process.
  void pack(std::span<const Pixel> pixels, Packer& packer) const;
  /// Replaces those of the same pixels.
  void unpack(std::span<const Pixel> pixels, Unpacker& unpacker);

  static std::size_t bytes_per_pixel(const FilmContents& contents);

 private:
  struct Radiance {
    std::array<double, 3> sum{};
    std::array<double, 3> square{};
    std::uint32_t count = 0;
    std::uint32_t taken = 0;  ///< with those that were dropped
  };
  struct Half {
    std::array<double, 3> sum{};
    std::uint32_t count = 0;
  };
  /// Sums in single precision: a filter that reads them does not see their rounding.
  struct Guide {
    std::array<float, 3> albedo{};
    std::array<float, 3> normal{};
  };
  /// What output variables show of primary hits.
  struct First {
    std::array<double, 3> albedo{};
    std::array<double, 3> normal{};
    std::array<double, 3> position{};
    std::array<double, 3> answer{};
    std::array<double, 3> node{};
    std::array<double, 3> cache{};
    double depth = 0.0;
    double error = 0.0;
    double training_count = 0.0;
    double resolution = 0.0;
    std::uint32_t count = 0;  ///< number of samples
    std::uint32_t asked = 0;
    std::uint32_t hits = 0;
    std::uint32_t cached = 0;
    float instance = -1.0f;
    float primitive = -1.0f;
  };
  static void add_first(First& p, const FirstHit& first);
  static double mean(const Radiance& p, std::size_t channel);
  /// Unbiased for independent samples, an upper bound for low-discrepancy samples.
  static double variance_of_mean(const Radiance& p, std::size_t channel);
  double half_mean(std::size_t pixel, bool second, std::size_t channel) const;
  std::size_t at(const Pixel& p) const { return rect_.index(p.x, p.y); }
  /// Pixels in rows from the top.
  struct Range {
    std::size_t begin;
    std::size_t end;
  };
  Layer layer(Aov aov, Range range) const;

  PixelRect rect_;
  int full_width_;
  int full_height_;
  FilmContents contents_;
  std::vector<Radiance> radiance_;
  std::vector<Half> half_;  ///< of the samples with even numbers; empty where it is not kept, as those below
  std::vector<Guide> guides_;
  std::vector<double> alpha_;
  std::vector<First> first_;
  std::vector<std::array<double, 3>> parts_;  ///< sums of all groups of a pixel, then those of the next
};

}  // namespace gatelight::renderer
