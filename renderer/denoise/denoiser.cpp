#include "renderer/denoise/denoiser.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <numeric>
#include <utility>

#include "base/errors.h"
#include "base/parallel/schedule.h"

namespace gatelight::renderer {
namespace {

/// The share of a call's time that each of both guides takes.
constexpr double kShareOfGuide = 0.2;

struct Progress {
  const DenoiseProgress& report;
  double begin;
  double end;
  bool cancelled = false;  ///< the library may still finish, and report success
};

bool monitor(void* user, double done) {
  Progress& progress = *static_cast<Progress*>(user);
  if (progress.report &&
      !progress.report(std::lerp(progress.begin, progress.end, std::clamp(done, 0.0, 1.0))))
    progress.cancelled = true;
  return !progress.cancelled;
}

int mebibytes(std::size_t bytes) {
  constexpr std::size_t kMost = std::numeric_limits<int>::max();
  return static_cast<int>(std::min(bytes >> 20, kMost));
}

bool has_guides(const NoisyImage& image) {
  return !image.albedo.empty() && !image.normal.empty();
}

/// A filter of the kind "RT". The images that it was given must outlive its execution.
class RayTracingFilter {
 public:
  RayTracingFilter(const oidn::Api& api, oidn::Device device, const NoisyImage& size,
                   std::size_t memory_limit_bytes)
      : api_(api),
        device_(device),
        filter_(api.NewFilter(device, "RT"), api.ReleaseFilter),
        width_(size.width),
        height_(size.height) {
    check();
    if (memory_limit_bytes > 0) set_int("maxMemoryMB", std::max(mebibytes(memory_limit_bytes), 1));
  }

  void set_image(const char* name, std::vector<float>& pixels) {
    api_.SetSharedFilterImage(filter_.get(), name, pixels.data(), oidn::kFloat3,
                              static_cast<std::size_t>(width_), static_cast<std::size_t>(height_), 0, 0, 0);
  }
  void set_bool(const char* name, bool value) { api_.SetFilterBool(filter_.get(), name, value); }
  void set_int(const char* name, int value) { api_.SetFilterInt(filter_.get(), name, value); }
  void set_float(const char* name, float value) { api_.SetFilterFloat(filter_.get(), name, value); }

  /// False where the progress cancelled it.
  bool execute(Progress progress) {
    const schedule::Section section("oidn");
    api_.SetFilterProgressMonitorFunction(filter_.get(), monitor, &progress);
    api_.CommitFilter(filter_.get());
    check();
    api_.ExecuteFilter(filter_.get());
    return check() && !progress.cancelled;
  }

 private:
  /// False where the last call was cancelled.
  bool check() const {
    const char* message = nullptr;
    const int error = api_.GetDeviceError(device_, &message);
    if (error == oidn::kNoError) return true;
    if (error == oidn::kCancelled) return false;
    const std::string text =
        fmt::format("denoising {}x{} pixels: {}", width_, height_, message ? message : "no reason");
    if (error == oidn::kOutOfMemory) throw OutOfMemory(text);
    throw MissingDenoiser(text);
  }

  const oidn::Api& api_;
  oidn::Device device_;
  std::unique_ptr<oidn::FilterHandle, void (*)(oidn::Filter)> filter_;
  int width_;
  int height_;
};

}  // namespace

std::string failure_to_denoise(const std::function<void()>& run) {
  try {
    run();
    return "";
  } catch (const OutOfMemory& error) {
    return error.what();
  } catch (const MissingDenoiser& error) {
    return error.what();
  } catch (const std::bad_alloc&) {
    return "denoising it needs more memory than there is";
  }
}

Denoiser::Denoiser(const OidnLibrary& library, int threads, std::size_t memory_limit_bytes)
    : api_(library.api),
      device_(api_.NewDevice(oidn::kCpuDevice), Release{api_.ReleaseDevice}),
      memory_limit_bytes_(memory_limit_bytes) {
  const char* message = nullptr;
  if (device_) {
    api_.SetDeviceInt(device_.get(), "numThreads", threads);
    // The threads are shared with the renderer, and with other programs.
    api_.SetDeviceBool(device_.get(), "setAffinity", false);
    api_.CommitDevice(device_.get());
  }
  if (api_.GetDeviceError(device_.get(), &message) != oidn::kNoError || !device_)
    throw MissingDenoiser(fmt::format("'{}': {}", library.path, message ? message : "no device"));
}

bool Denoiser::filter(NoisyImage& image, const FilterOptions& options,
                      const DenoiseProgress& progress) const {
  if (image.width <= 0 || image.height <= 0) return true;
  double begin = 0.0;
  if (options.prefilter == Prefilter::accurate && has_guides(image)) {
    for (const auto& [name, guide] : {std::pair("albedo", &image.albedo), {"normal", &image.normal}}) {
      RayTracingFilter filter(api_, device_.get(), image, memory_limit_bytes_);
      filter.set_image(name, *guide);
      filter.set_image("output", *guide);
      // The larger network gains nothing here, and takes twice the time (README.md).
      filter.set_int("quality", oidn::kFast);
      if (!filter.execute({progress, begin, begin + kShareOfGuide})) return false;
      begin += kShareOfGuide;
    }
  }
  const double end = image.alpha.empty() ? 1.0 : std::midpoint(begin, 1.0);
  return filter_plane(image.color, image, options, progress, begin, end) &&
         (image.alpha.empty() || filter_alpha(image, options, progress, end));
}

bool Denoiser::filter_plane(std::vector<float>& color, NoisyImage& guides, const FilterOptions& options,
                            const DenoiseProgress& progress, double begin, double end) const {
  RayTracingFilter filter(api_, device_.get(), guides, memory_limit_bytes_);
  filter.set_image("color", color);
  filter.set_image("output", color);
  if (has_guides(guides)) {
    filter.set_image("albedo", guides.albedo);
    filter.set_image("normal", guides.normal);
    filter.set_bool("cleanAux", options.prefilter != Prefilter::fast);
  }
  filter.set_bool("hdr", true);
  filter.set_float("inputScale", options.scale);
  filter.set_int("quality", options.quality == DenoiseQuality::fast ? oidn::kFast : oidn::kHigh);
  return filter.execute({progress, begin, end});
}

bool Denoiser::filter_alpha(NoisyImage& image, const FilterOptions& options, const DenoiseProgress& progress,
                            double begin) const {
  std::vector<float> color;
  color.reserve(3 * image.alpha.size());
  for (const float a : image.alpha) color.insert(color.end(), 3, a);
  FilterOptions of_alpha = options;
  of_alpha.scale = 1.0f;
  if (!filter_plane(color, image, of_alpha, progress, begin, 1.0)) return false;
  const auto column = [&](int x) { return static_cast<std::size_t>(std::clamp(x, 0, image.width - 1)); };
  const auto row = [&](int y) {
    return static_cast<std::size_t>(std::clamp(y, 0, image.height - 1)) *
           static_cast<std::size_t>(image.width);
  };
  const std::vector<float> noisy = image.alpha;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const std::size_t at = row(y) + column(x);
      bool same = noisy[at] == 0.0f || noisy[at] == 1.0f;
      for (int v = -1; v <= 1; ++v) {
        for (int u = -1; u <= 1; ++u) same = same && noisy[row(y + v) + column(x + u)] == noisy[at];
      }
      if (!same) image.alpha[at] = std::clamp(color[3 * at], 0.0f, 1.0f);
    }
  }
  return true;
}

}  // namespace gatelight::renderer
