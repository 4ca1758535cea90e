#pragma once
// Makes camera samples from pixels, and adds their results to the film.

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/film/camera.h"
#include "renderer/film/camera_sample.h"
#include "renderer/film/film.h"
#include "renderer/film/pixel_filter.h"
#include "renderer/film/tiles.h"
#include "renderer/settings/statistics.h"

namespace gatelight::renderer {

/// CameraSample::contribution_threshold stays 0.
CameraSample make_camera_sample(const PixelSample& sample, const RenderOptions& options, const Camera& camera,
                                const FilterSampler& filter);

/// Makes samples that were taken from the film. CameraSample::contribution_threshold follows from the samples
/// that the film has.
void make_camera_samples(std::span<const PixelSample> wanted, const Film& film, const RenderOptions& options,
                         const Camera& camera, const FilterSampler& filter,
                         std::vector<CameraSample>& samples);

/// Counts the samples that were dropped or clamped on the way to the film.
struct SampleCounts {
  std::uint64_t nonfinite = 0;
  std::uint64_t clamped = 0;
  std::vector<NonFiniteSample> located;

  void add(const SampleCounts& other);
};

/// Keeps the first 16 in the order of (y, x, sample), for the statistics.
void keep_first(std::vector<NonFiniteSample>& samples);

/// Adds the results of samples that were taken from the film. `first_hits` is empty or as long as `samples`.
/// `parts` is empty, or has for each sample the light of each part that the film keeps.
void add_to_film(std::span<const PixelSample> samples, const RenderOptions& options,
                 std::span<const SampleResult> results, std::span<const FirstHit> first_hits, Film& film,
                 SampleCounts& counts, std::span<const Color> parts = {});

}  // namespace gatelight::renderer
