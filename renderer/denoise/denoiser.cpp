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

/// The share of a call's time that both guides take.
constexpr double kShareOfGuides = 0.4;

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
  constexpr std::size_t kMax = std::numeric_limits<int>::max();
  return static_cast<int>(std::min(bytes >> 20, kMax));
}

bool is_empty(const PixelRect& rect) {
  return rect.width() <= 0 || rect.height() <= 0;
}

bool has_guides(const NoisyImage& image) {
  return !image.albedo.empty() && !image.normal.empty();
}

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
    return "denoising it needs more memory than is available";
  }
}

/// A filter of the kind "RT" for images of one size. Making one takes as long as filtering a few hundred rows
/// on many cores, and ending the last one gives its memory back to the system; so they are kept.
class Denoiser::Filter {
 public:
  Filter(const oidn::Api& api, oidn::Device device, const FilterKind& kind, std::size_t memory_limit_bytes)
      : api_(api), device_(device), kind_(kind), filter_(api.NewFilter(device, "RT"), api.ReleaseFilter) {
    check();
    if (memory_limit_bytes > 0)
      api_.SetFilterInt(filter_.get(), "maxMemoryMB", std::max(mebibytes(memory_limit_bytes), 1));
    // The larger network gains nothing for guides, and takes twice the time (README.md).
    api_.SetFilterInt(filter_.get(), "quality", kind.fast ? oidn::kFast : oidn::kHigh);
    if (kind.plane != FilterKind::Plane::color) return;
    api_.SetFilterBool(filter_.get(), "hdr", true);
    if (kind.guides) api_.SetFilterBool(filter_.get(), "cleanAux", kind.clean_guides);
  }

  const FilterKind& kind() const { return kind_; }
  /// The pixels must outlive execute(). Rows of the plane have `stride` pixels, of which the first one is at
  /// `begin`.
  void set_image(const char* name, const std::vector<float>& pixels, std::size_t begin, std::size_t stride) {
    constexpr std::size_t kPixel = 3 * sizeof(float);
    api_.SetSharedFilterImage(filter_.get(), name, const_cast<float*>(pixels.data()), oidn::kFloat3,
                              static_cast<std::size_t>(kind_.width), static_cast<std::size_t>(kind_.height),
                              begin * kPixel, kPixel, stride * kPixel);
  }
  void set_scale(float scale) { api_.SetFilterFloat(filter_.get(), "inputScale", scale); }
  void commit() {
    api_.CommitFilter(filter_.get());
    check();
  }
  /// False where the progress cancelled it.
  bool execute(Progress progress) {
    const schedule::Section section("oidn");
    api_.SetFilterProgressMonitorFunction(filter_.get(), monitor, &progress);
    commit();
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
        fmt::format("denoising {}x{} pixels: {}", kind_.width, kind_.height, message ? message : "no reason");
    if (error == oidn::kOutOfMemory) throw OutOfMemory(text);
    throw MissingDenoiser(text);
  }

  const oidn::Api& api_;
  oidn::Device device_;
  FilterKind kind_;
  std::unique_ptr<oidn::FilterHandle, void (*)(oidn::Filter)> filter_;
};

Denoiser::Denoiser(const OidnLibrary& library, int threads, std::size_t memory_limit_bytes)
    : api_(library.api),
      device_(api_.NewDevice(oidn::kCpuDevice), api_.ReleaseDevice),
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

Denoiser::~Denoiser() = default;

Denoiser::Filter& Denoiser::filter_of(const FilterKind& kind) {
  constexpr std::size_t kMax = 8;  // a picture has three sizes: a band, the last one, and a strip
  const auto found = std::find_if(filters_.begin(), filters_.end(),
                                  [&](const auto& filter) { return filter->kind() == kind; });
  if (found != filters_.end()) {
    std::rotate(filters_.begin(), found, found + 1);  // the last used comes first
  } else {
    filters_.insert(filters_.begin(),
                    std::make_unique<Filter>(api_, device_.get(), kind, memory_limit_bytes_));
    if (filters_.size() > kMax) filters_.pop_back();
  }
  return *filters_.front();
}

void Denoiser::prepare(int width, int height, const FilterOptions& options, bool guides,
                       const std::optional<PixelRect>& noisy) {
  const std::lock_guard lock(mutex_);
  const schedule::Section section("beside");
  const std::vector<float> none(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  // The largest comes first: all of them share its memory.
  const auto make = [&](FilterKind::Plane plane, const PixelRect& part) {
    Filter& filter = filter_of(kind_of(plane, part.width(), part.height(), options, guides));
    set_images(filter, none, none, none, part, width);
    filter.commit();
  };
  const PixelRect all{0, 0, width, height}, part = noisy.value_or(all);
  make(FilterKind::Plane::color, all);
  if (!guides || options.prefilter != Prefilter::accurate || is_empty(part)) return;
  make(FilterKind::Plane::albedo, part);
  make(FilterKind::Plane::normal, part);
}

FilterKind Denoiser::kind_of(FilterKind::Plane plane, int width, int height, const FilterOptions& options,
                             bool guides) {
  const bool color = plane == FilterKind::Plane::color;
  return {plane,           width,
          height,          !color || options.quality == DenoiseQuality::fast,
          color && guides, color && guides && options.prefilter != Prefilter::fast};
}

void Denoiser::set_images(Filter& filter, const std::vector<float>& plane, const std::vector<float>& albedo,
                          const std::vector<float>& normal, const PixelRect& part, int width) {
  constexpr const char* kNames[] = {"color", "albedo", "normal"};
  const auto stride = static_cast<std::size_t>(width);
  const std::size_t begin = static_cast<std::size_t>(part.y0) * stride + static_cast<std::size_t>(part.x0);
  filter.set_image(kNames[static_cast<std::size_t>(filter.kind().plane)], plane, begin, stride);
  filter.set_image("output", plane, begin, stride);
  if (!filter.kind().guides) return;
  filter.set_image("albedo", albedo, begin, stride);
  filter.set_image("normal", normal, begin, stride);
}

bool Denoiser::filter(NoisyImage& image, const FilterOptions& options, const DenoiseProgress& progress) {
  if (image.width <= 0 || image.height <= 0) return true;
  const std::lock_guard lock(mutex_);
  bool complete = false;
  try {
    complete = filter_all(image, options, progress);
  } catch (...) {
    filters_.clear();
    throw;
  }
  if (!complete) filters_.clear();  // where one has stopped is unknown
  return complete;
}

/// Where they are noisy.
bool Denoiser::filter_guides(NoisyImage& image, const FilterOptions& options,
                             const DenoiseProgress& progress) {
  const PixelRect part = image.noisy_part();
  double begin = 0.0;
  for (const auto& [plane, guide] :
       {std::pair(FilterKind::Plane::albedo, &image.albedo), {FilterKind::Plane::normal, &image.normal}}) {
    Filter& filter = filter_of(kind_of(plane, part.width(), part.height(), options, true));
    set_images(filter, *guide, {}, {}, part, image.width);
    if (!filter.execute({progress, begin, begin + 0.5 * kShareOfGuides})) return false;
    begin += 0.5 * kShareOfGuides;
  }
  return true;
}

bool Denoiser::filter_all(NoisyImage& image, const FilterOptions& options, const DenoiseProgress& progress) {
  double begin = 0.0;
  if (options.prefilter == Prefilter::accurate && has_guides(image) && !is_empty(image.noisy_part())) {
    if (!filter_guides(image, options, progress)) return false;
    begin = kShareOfGuides;
  }
  const double end = image.alpha.empty() ? 1.0 : std::midpoint(begin, 1.0);
  return filter_plane(image.color, image, options, progress, begin, end) &&
         (image.alpha.empty() || filter_alpha(image, options, progress, end));
}

bool Denoiser::filter_plane(std::vector<float>& color, const NoisyImage& guides, const FilterOptions& options,
                            const DenoiseProgress& progress, double begin, double end) {
  Filter& filter =
      filter_of(kind_of(FilterKind::Plane::color, guides.width, guides.height, options, has_guides(guides)));
  set_images(filter, color, guides.albedo, guides.normal, {0, 0, guides.width, guides.height}, guides.width);
  filter.set_scale(options.scale);
  return filter.execute({progress, begin, end});
}

bool Denoiser::filter_alpha(NoisyImage& image, const FilterOptions& options, const DenoiseProgress& progress,
                            double begin) {
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
