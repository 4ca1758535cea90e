#pragma once
// The output variables: additional layers of a picture. Options, film, files and window all use one table.

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gatelight::renderer {

enum class Aov : std::uint8_t {
  albedo,
  normal,
  depth,
  position,
  primitive_id,
  instance_id,
  alpha,
  sample_count,
  variance,
  raw,
  error,
  denoising,
  motion,
  motion_next,
  diffuse_direct,
  diffuse_indirect,
  glossy_direct,
  glossy_indirect,
  transmission_direct,
  transmission_indirect,
  volume_direct,
  volume_indirect,
  emission,
  background,
  cache_radiance,
  cache_answer,
  cache_error,
  training_count,
  resolution,
  nearest_node
};

/// Where the values of an output variable come from.
enum class AovSource : std::uint8_t {
  first_hit,  ///< the film's data of primary hits
  samples,    ///< the film's sums of the samples
  pass,       ///< a part of the samples' light; all passes sum to the picture
  other,      ///< it is added to the finished picture
};

/// How a pixel of the picture is computed from the film pixels that it covers (`supersampling`).
enum class AovScaling : std::uint8_t {
  mean,
  sum,
  mean_variance,  ///< the variance of their mean
  first,          ///< the value of one of them: places and ids have no mean
};

/// What a picture needs to fill the variable, which is black otherwise.
enum class AovNeeds : std::uint8_t {
  nothing,
  light,           ///< an integrator of light: `path` or `nrc`
  frames,          ///< an animation
  cache,           ///< an integrator with a cache
  radiance_cache,  ///< nrc
  mesh_colors,     ///< a cache with the encoding `gate`
};

/// How the window shows it.
enum class AovLook : std::uint8_t {
  light,      ///< as the picture
  color,      ///< as it is: a reflectance
  direction,  ///< x, y, z as red, green, blue
  id,         ///< a colour for each number
  heat,       ///< from dark to bright, relative to its own range
};

struct AovInfo {
  Aov aov;
  std::string_view name;      ///< of the option and of the layer
  std::string_view channels;  ///< letters, or one word
  AovSource source = AovSource::first_hit;
  AovNeeds needs = AovNeeds::nothing;
  AovScaling scaling = AovScaling::mean;
  AovLook look = AovLook::heat;
  std::string_view label;  ///< of its button in the window; empty: it has none
  bool half = false;       ///< half precision suffices
  std::string_view help;   ///< explains the name
};

constexpr AovInfo render_pass(Aov aov, std::string_view name) {
  return {.aov = aov,
          .name = name,
          .channels = "RGB",
          .source = AovSource::pass,
          .needs = AovNeeds::light,
          .look = AovLook::light};
}

/// In the order of the enumeration. Cache variables hold the values at the vertex of a path's first query;
/// without a query they are black.
inline constexpr AovInfo kAovs[] = {
    {.aov = Aov::albedo,
     .name = "albedo",
     .channels = "RGB",
     .look = AovLook::color,
     .label = "albedo",
     .half = true},
    {.aov = Aov::normal,
     .name = "normal",
     .channels = "XYZ",
     .look = AovLook::direction,
     .label = "normal",
     .half = true},
    {.aov = Aov::depth, .name = "depth", .channels = "Z", .scaling = AovScaling::first, .label = "depth"},
    {.aov = Aov::position, .name = "position", .channels = "XYZ", .scaling = AovScaling::first},
    {.aov = Aov::primitive_id, .name = "primitive", .channels = "id", .scaling = AovScaling::first},
    {.aov = Aov::instance_id,
     .name = "instance",
     .channels = "id",
     .scaling = AovScaling::first,
     .look = AovLook::id,
     .label = "objects"},
    {.aov = Aov::alpha, .name = "alpha", .channels = "A", .source = AovSource::samples},
    {.aov = Aov::sample_count,
     .name = "samples",
     .channels = "count",
     .source = AovSource::samples,
     .scaling = AovScaling::sum},
    {.aov = Aov::variance,
     .name = "variance",
     .channels = "RGB",
     .source = AovSource::samples,
     .scaling = AovScaling::mean_variance},
    {.aov = Aov::raw,
     .name = "raw",
     .channels = "RGB",
     .source = AovSource::samples,
     .look = AovLook::light,
     .help = "the mean of the samples"},
    {.aov = Aov::error,
     .name = "error",
     .channels = "RGB",
     .source = AovSource::samples,
     .label = "error",
     .help = "the estimated standard error"},
    {.aov = Aov::denoising,
     .name = "denoising",
     .channels = "RGB",
     .source = AovSource::other,
     .help = "the input of `gatelight denoise`"},
    {.aov = Aov::motion,
     .name = "motion",
     .channels = "XY",
     .source = AovSource::other,
     .needs = AovNeeds::frames,
     .help = "pixels since the frame before, y up"},
    {.aov = Aov::motion_next,
     .name = "motion-next",
     .channels = "XY",
     .source = AovSource::other,
     .needs = AovNeeds::frames},
    render_pass(Aov::diffuse_direct, "diffuse-direct"),
    render_pass(Aov::diffuse_indirect, "diffuse-indirect"),
    render_pass(Aov::glossy_direct, "glossy-direct"),
    render_pass(Aov::glossy_indirect, "glossy-indirect"),
    render_pass(Aov::transmission_direct, "transmission-direct"),
    render_pass(Aov::transmission_indirect, "transmission-indirect"),
    render_pass(Aov::volume_direct, "volume-direct"),
    render_pass(Aov::volume_indirect, "volume-indirect"),
    render_pass(Aov::emission, "emission"),
    render_pass(Aov::background, "background"),
    {.aov = Aov::cache_radiance,
     .name = "cache-radiance",
     .channels = "RGB",
     .needs = AovNeeds::radiance_cache,
     .look = AovLook::light,
     .label = "bare cache",
     .help = "the picture that the cache gives alone"},
    {.aov = Aov::cache_answer,
     .name = "cache-answer",
     .channels = "RGB",
     .needs = AovNeeds::cache,
     .half = true,
     .help = "before reflectance"},
    {.aov = Aov::cache_error,
     .name = "cache-error",
     .channels = "error",
     .needs = AovNeeds::radiance_cache,
     .help = "relative, squared"},
    {.aov = Aov::training_count,
     .name = "training-count",
     .channels = "count",
     .needs = AovNeeds::mesh_colors},
    {.aov = Aov::resolution, .name = "resolution", .channels = "R", .needs = AovNeeds::mesh_colors},
    {.aov = Aov::nearest_node,
     .name = "nearest-node",
     .channels = "RGB",
     .needs = AovNeeds::mesh_colors,
     .half = true,
     .help = "the Voronoi cells of the nodes"},
};

inline const AovInfo& info_of(Aov aov) {
  return kAovs[static_cast<std::size_t>(aov)];
}
/// The row of a layer; null if the layer is not an output variable.
inline const AovInfo* find_aov(std::string_view layer) {
  const auto* const found =
      std::find_if(std::begin(kAovs), std::end(kAovs), [&](const AovInfo& row) { return row.name == layer; });
  return found == std::end(kAovs) ? nullptr : found;
}

inline bool has(std::span<const Aov> aovs, Aov aov) {
  return std::find(aovs.begin(), aovs.end(), aov) != aovs.end();
}

/// The channels of an output variable: each letter, or one word.
std::vector<std::string> channels_of(const AovInfo& aov);
/// The passes among some output variables, in their order.
std::vector<Aov> passes_among(std::span<const Aov> aovs);
/// All passes. Their sum is the picture.
std::vector<Aov> all_passes();

}  // namespace gatelight::renderer
