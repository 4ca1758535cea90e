#pragma once
// Sums samples for each pixel. A pixel belongs to one task at a time and adds its samples in order, so its
// bits do not depend on the number of threads. Sums are double, so that a million samples do not drift.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/film/camera_sample.h"
#include "renderer/film/film_sums.h"
#include "renderer/film/tiles.h"
#include "renderer/image/picture.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

/// The data that a film keeps in addition to the sums of its samples.
struct FilmContents {
  std::vector<Aov> aovs;  ///< layers of resolve()
  bool half = false;      ///< the mean of every other sample
  bool guides = false;    ///< albedo and normal behind mirrors and clear glass
  bool alpha = false;     ///< 1 minus the visible share of the background
  /// The layers of parts of the light: of each light group, then the passes among `aovs`.
  std::vector<std::string> parts;
};

/// The contents that these options need. A denoiser that is not chosen yet counts as one.
FilmContents film_contents(const RenderOptions& options, const std::vector<std::string>& light_groups = {});

/// Planes of a film that are no layers of resolve().
enum class Plane : std::uint8_t {
  mean,    ///< 3 floats a pixel
  half_a,  ///< the mean of the samples with even numbers
  half_b,  ///< the mean of the samples with odd numbers
  albedo,  ///< of the guides, 3 floats
  normal,  ///< the same
  alpha,   ///< 1 float
};

class Film {
 public:
  Film(PixelRect rect, int full_width, int full_height, FilmContents contents);

  const PixelRect& rect() const { return rect_; }
  std::size_t pixels() const { return sums_.radiance.size(); }
  /// Whether it keeps data of primary hits.
  bool needs_first_hits() const {
    return !sums_.guides.empty() || !sums_.alpha.empty() || !sums_.first_hits.empty();
  }
  /// The layers of the parts of its light.
  const std::vector<std::string>& parts() const { return contents_.parts; }

  /// Number of samples of a pixel so far, including dropped ones.
  std::uint32_t taken(const Pixel& p) const { return sums_.radiance[at(p)].taken; }
  /// Number of these samples that were not dropped.
  std::uint32_t count(const Pixel& p) const { return sums_.radiance[at(p)].count; }
  /// Returns the pixel's next sample and counts it as taken.
  PixelSample take(const Pixel& p) { return {p, sums_.radiance[at(p)].taken++}; }
  /// The same for each pixel. Replaces `samples`.
  void take(std::span<const Pixel> pixels, std::vector<PixelSample>& samples);

  /// Adds a sample that was taken. The samples of a pixel come in the order of their numbers.
  void add(const PixelSample& sample, const Color& radiance);
  void add(const PixelSample& sample, const FirstHit& first);
  /// Adds the light of each part, times `scale`, for a sample that was added.
  void add_parts(const Pixel& p, std::span<const Color> parts, float scale);

  /// The means so far, the layers of the output variables but AovSource::other, and the parts of the light. A
  /// pixel without samples is black. Runs in the caller's arena.
  Picture resolve() const { return resolve(rect_.y0, rect_.y1); }
  /// The same for the rows first <= y < end.
  Picture resolve(int first, int end) const;

  /// A plane of the rows first <= y < end. The film must keep it. A pixel without samples is 0, and one
  /// without samples of a half has the mean of all. Runs in the caller's arena.
  std::vector<float> plane(Plane plane, int first, int end) const;
  /// The same of a part of the light: 3 floats a pixel.
  std::vector<float> part(std::size_t number, int first, int end) const;
  /// The layer of an output variable that is no pass. Those of the primary hit need a film that keeps it.
  Layer layer(Aov aov) const { return layer(aov, {0, pixels()}); }
  /// Mean number of samples of a pixel that were not dropped.
  double samples_per_pixel() const;

  /// CameraSample::contribution_threshold for a pixel's next sample: a share of its mean so far.
  float contribution_threshold(const Pixel& p) const;

  const FilmSums& sums() const { return sums_; }
  /// `sums` has the planes of this film.
  void set_sums(FilmSums sums);

  /// The exact sums of some pixels, for a film of the same kind in another process.
  void pack(std::span<const Pixel> pixels, Packer& packer) const;
  /// Replaces the sums of the same pixels.
  void unpack(std::span<const Pixel> pixels, Unpacker& unpacker);

  static std::size_t bytes_per_pixel(const FilmContents& contents);

 private:
  static double mean(const RadianceSum& p, std::size_t channel);
  /// Unbiased for independent samples, an upper bound for low-discrepancy samples.
  static double variance_of_mean(const RadianceSum& p, std::size_t channel);
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
  FilmSums sums_;
};

}  // namespace gatelight::renderer
