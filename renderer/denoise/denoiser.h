#pragma once
// A device of Open Image Denoise that filters pictures in memory.

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "renderer/denoise/oidn_library.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/settings/enums.h"

namespace gatelight::renderer {

/// Pixels in rows from the top, 3 floats each but for alpha.
struct NoisyImage {
  int width = 0;
  int height = 0;
  std::vector<float> color;   ///< linear
  std::vector<float> albedo;  ///< 0 to 1; empty: no guides
  std::vector<float> normal;  ///< -1 to 1, in any space, of any length; empty: no guides
  std::vector<float> alpha;   ///< 1 float a pixel, 0 to 1; empty: none
  /// Outside of these pixels the guides have no noise, except at edges; nullopt: they have it everywhere.
  std::optional<PixelRect> noisy_guides;

  PixelRect noisy_part() const { return noisy_guides.value_or(PixelRect{0, 0, width, height}); }
};

enum class DenoiseQuality : std::uint8_t { fast, high };

struct FilterOptions {
  Prefilter prefilter = Prefilter::accurate;
  DenoiseQuality quality = DenoiseQuality::high;
  /// Multiplies colours before the filter, and divides them after it. Parts of a picture need the same one.
  float scale = 1.0f;
};

/// The images that a filter is made for.
struct FilterKind {
  enum class Plane : std::uint8_t { color, albedo, normal };
  Plane plane = Plane::color;
  int width = 0;  ///< of the part that is filtered
  int height = 0;
  bool fast = false;          ///< the smaller network
  bool guides = false;        ///< of `color`
  bool clean_guides = false;  ///< they are denoised
  bool operator==(const FilterKind&) const = default;
};

/// Called with the share that is done, in [0, 1]; false cancels.
using DenoiseProgress = std::function<bool(double done)>;

/// Runs a function that denoises. Returns the reason where the denoiser or memory failed, else an empty text.
std::string failure_to_denoise(const std::function<void()>& run);

class Denoiser {
 public:
  /// Filters use `threads` threads. `memory_limit_bytes` limits the memory of a filter, at the cost of time;
  /// 0: the library's own limit. The library must outlive the object. Throws MissingDenoiser.
  Denoiser(const OidnLibrary& library, int threads, std::size_t memory_limit_bytes = 0);
  ~Denoiser();

  /// Replaces colours and alpha by denoised ones, and the noisy guides if they are filtered. Alpha
  /// stays 0 or 1 where all pixels around are. The same bits for any number of threads. Returns false where
  /// `progress` cancelled; the image is then undefined. Throws OutOfMemory, or MissingDenoiser with the
  /// library's message. Source: "RT" filter, "Open Image Denoise API".
  bool filter(NoisyImage& image, const FilterOptions& options, const DenoiseProgress& progress = {});
  /// Sets up what filter() needs for images of this size, with or without guides: one thread works for some
  /// tens of milliseconds, which can be done beside other work. `noisy`: NoisyImage::noisy_guides. Throws as
  /// filter() does.
  void prepare(int width, int height, const FilterOptions& options, bool guides,
               const std::optional<PixelRect>& noisy = {});

 private:
  class Filter;
  Filter& filter_of(const FilterKind& kind);
  static FilterKind kind_of(FilterKind::Plane plane, int width, int height, const FilterOptions& options,
                            bool guides);
  /// A part of planes whose rows have `width` pixels.
  static void set_images(Filter& filter, const std::vector<float>& plane, const std::vector<float>& albedo,
                         const std::vector<float>& normal, const PixelRect& part, int width);
  bool filter_guides(NoisyImage& image, const FilterOptions& options, const DenoiseProgress& progress);
  bool filter_all(NoisyImage& image, const FilterOptions& options, const DenoiseProgress& progress);
  /// Filters `color`, 3 floats a pixel, in place.
  bool filter_plane(std::vector<float>& color, const NoisyImage& guides, const FilterOptions& options,
                    const DenoiseProgress& progress, double begin, double end);
  bool filter_alpha(NoisyImage& image, const FilterOptions& options, const DenoiseProgress& progress,
                    double begin);

  const oidn::Api& api_;
  std::unique_ptr<oidn::DeviceHandle, void (*)(oidn::Device)> device_;
  std::size_t memory_limit_bytes_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Filter>> filters_;  ///< the last used comes first
};

}  // namespace gatelight::renderer
