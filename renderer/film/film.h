#pragma once
// Sums samples for each pixel. A pixel belongs to one task at a time and adds its samples in order, so its
// bits do not depend on the number of threads. Sums are double, so that a million samples do not drift.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "renderer/film/camera_sample.h"
#include "renderer/film/sample_density.h"
#include "renderer/film/tiles.h"
#include "renderer/image/picture.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/ranks/packing.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

/// The exact sums of a film, pixel after pixel: all samples, then those of both halves where the film keeps
/// them. The `guide` and `first` members are empty if the film keeps nothing of first hits.
struct FilmState {
  std::vector<double> radiance;
  std::vector<std::uint32_t> radiance_counts;
  std::vector<double> guides;
  std::vector<std::uint32_t> guide_counts;
  std::vector<double> first;
  std::vector<std::uint32_t> first_counts;
  std::vector<float> first_ids;
  // Of a film whose passes follow a density: its values, half after half, and the passes that followed it.
  std::vector<float> density;
  std::vector<std::uint32_t> density_passes;
  std::vector<double> parts;  ///< of groups of lights
};

/// The layers of groups of lights begin with it.
inline constexpr const char* kLightLayer = "light-";

class Film {
 public:
  /// `light_groups`: the names of groups of lights, whose parts the film keeps.
  Film(PixelRect rect, int full_width, int full_height, std::span<const Aov> aovs,
       std::vector<std::string> light_groups = {});

  const PixelRect& rect() const { return rect_; }
  std::size_t pixels() const { return radiance_.size(); }
  /// Whether some requested output variable comes from the primary hit.
  bool needs_first_hits() const { return !guides_.empty() || !first_.empty(); }
  const std::vector<std::string>& light_groups() const { return light_groups_; }

  /// Samples of a pixel so far, those that were dropped among them.
  std::uint32_t taken(const Pixel& p) const { return radiance_[at(p)].taken; }
  /// Of these, the samples that count.
  std::uint32_t count(const Pixel& p) const { return radiance_[at(p)].count; }
  /// Counts the pixel's next sample. Where the film keeps halves, it belongs to the one that has less.
  PixelSample take(const Pixel& p);
  /// Counts the next sample of a half. The film must keep halves.
  PixelSample take(const Pixel& p, std::size_t half);

  /// Passes from now on follow a density. The film must keep halves.
  void follow(SampleDensity density);
  /// Takes what the pixels get in the pass that comes after `ahead` more of them: the next sample of each, or
  /// what the density says. Replaces `samples`.
  void take_pass(std::span<const Pixel> pixels, int ahead, std::vector<PixelSample>& samples);
  /// Whether there is a density that no pass has followed yet.
  bool new_density() const { return density_ && density_passes_ == 0; }
  /// So many passes have ended.
  void end_passes(int passes) { density_passes_ += static_cast<std::uint32_t>(passes); }

  /// Of samples that were taken, in the order of their numbers in each half.
  /// `seen`: the part of it that the camera sees itself (FirstHit::seen).
  void add(const PixelSample& sample, const Color& radiance, const Color& seen = Color::Zero());
  void add(const PixelSample& sample, const FirstHit& first);
  /// What each group of lights gives a sample that was added, times `scale`.
  void add_parts(const Pixel& p, std::span<const Color> parts, float scale);

  /// The means so far. A pixel without samples is black. Runs in the caller's arena.
  Picture resolve() const { return resolve(rect_.y0, rect_.y1); }
  /// The same of the rows first <= y < end.
  Picture resolve(int first, int end) const;

  /// The layer of an output variable. Those of the primary hit need a film that keeps it.
  Layer layer(Aov aov) const { return layer(aov, {0, pixels()}); }
  /// Mean number of samples of a pixel that count.
  double samples_per_pixel() const;

  /// CameraSample::faint for a pixel's next sample: a share of its mean so far.
  float faint(const Pixel& p) const;

  FilmState export_state() const;
  /// The state comes from a film with the same size and output variables.
  void import_state(const FilmState& state);

  /// The exact sums of some pixels, for a film of the same kind in another process. Neither density nor the
  /// number of its passes goes with them.
  void pack(std::span<const Pixel> pixels, Packer& packer) const;
  /// Replaces those of the same pixels.
  void unpack(std::span<const Pixel> pixels, Unpacker& unpacker);
  const std::optional<SampleDensity>& density() const { return density_; }

  static std::size_t bytes_per_pixel(std::span<const Aov> aovs, std::size_t light_groups = 0);

 private:
  struct Radiance {
    std::array<double, 3> sum{};
    std::array<double, 3> square{};
    std::uint32_t count = 0;
    std::uint32_t taken = 0;  ///< with those that were dropped
  };
  /// What reconstruction reads of first hits. The `half` members are of the first half.
  struct Guide {
    std::array<double, 3> albedo{};
    std::array<double, 3> normal{};
    std::array<double, 3> cache{};
    std::array<double, 3> cache_half{};
    double depth = 0.0;
    double alpha = 0.0;
    double alpha_half = 0.0;
    std::uint32_t count = 0;  ///< number of samples
    std::uint32_t count_half = 0;
    std::uint32_t hits = 0;
    std::uint32_t cached = 0;
    std::uint32_t cached_half = 0;
    std::uint32_t behind = 0;  ///< of `cached`, those that the cache knows behind the guide's surface
  };
  /// What other output variables show of them.
  struct First {
    std::array<double, 3> albedo{};
    std::array<double, 3> normal{};
    std::array<double, 3> position{};
    std::array<double, 3> answer{};
    std::array<double, 3> node{};
    double depth = 0.0;
    double error = 0.0;
    double training_count = 0.0;
    double resolution = 0.0;
    std::uint32_t count = 0;  ///< number of samples
    std::uint32_t asked = 0;
    std::uint32_t hits = 0;
    float instance = -1.0f;
    float primitive = -1.0f;
  };
  static void add_guide(Guide& p, const FirstHit& first, bool first_half);
  static void add_first(First& p, const FirstHit& first);
  static double mean_of(const Radiance& p, std::size_t channel);
  /// Unbiased for independent samples, an upper bound for low-discrepancy samples.
  static double variance_of_mean(const Radiance& p, std::size_t channel);
  double seen_mean(std::size_t half, std::size_t pixel, std::size_t channel) const;
  /// The halves of a pixel whose numbers of samples differ.
  bool uneven(std::size_t pixel) const;
  /// Weighed as if the samples had gone to the halves in turn: how many a half has depends on the other half,
  /// and what depends on samples must not decide how much they count.
  double mean(std::size_t pixel, std::size_t channel) const;
  double variance(std::size_t pixel, std::size_t channel) const;
  std::size_t at(const Pixel& p) const { return rect_.index(p.x, p.y); }
  /// Pixels in rows from the top.
  struct Range {
    std::size_t begin;
    std::size_t end;
  };
  Layer layer(Aov aov, Range range) const;
  /// The layers of Aov::reconstruction that are no output variables of their own.
  void add_guides(std::vector<Layer>& layers, Range range) const;
  void add_halves(std::vector<Layer>& layers, Range range) const;
  void add_light_groups(std::vector<Layer>& layers, Range range) const;

  PixelRect rect_;
  int full_width_;
  int full_height_;
  std::vector<Aov> aovs_;
  std::vector<Radiance> radiance_;
  /// Samples in turn, without what the camera sees itself; empty where nobody asks.
  std::array<std::vector<Radiance>, 2> halves_;
  std::array<std::vector<std::array<double, 3>>, 2> seen_;  ///< sums of that, as long as halves_
  std::vector<Guide> guides_;                               ///< empty where nobody asks
  std::vector<First> first_;                                ///< the same
  std::vector<std::string> light_groups_;
  std::vector<std::array<double, 3>> parts_;  ///< sums of all groups of a pixel, then those of the next
  std::optional<SampleDensity> density_;
  std::uint32_t density_passes_ = 0;  ///< that followed the density
};

}  // namespace gatelight::renderer
