#pragma once
// What a plan consists of: scenes, and the series of pictures that are made of each.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/settings/render_settings.h"
#include "apps/sweep/flag_values.h"
#include "renderer/settings/values.h"

namespace gatelight::apps {

/// What a picture is compared with.
enum class ReferenceKind : std::uint8_t {
  path,   ///< radiance
  ao,     ///< ambient occlusion
  cache,  ///< what the bare cache should answer (nrc --view cache)
};
inline constexpr renderer::Choice<ReferenceKind> kReferenceKinds[] = {
    {"path", ReferenceKind::path}, {"ao", ReferenceKind::ao}, {"cache", ReferenceKind::cache}};

/// --cache-memory same-as-gate: as many bytes as this cache takes, divided.
struct GateMemory {
  RenderSettings settings;
  double divisor = 1.0;
};

/// Cells that differ in seed and step count (samples of a plain integrator) alone: a line in a plot. With one
/// seed it is a run: what one training, or one rendering, gives.
struct PlannedSeries {
  std::string label;        ///< "nrc gate features 8"
  FlagValues axes;          ///< of what varies in this sweep, without dashes
  FlagValues flags;         ///< of a cell, without seed and point
  RenderSettings settings;  ///< complete, but for scene, seed and point
  ReferenceKind reference = ReferenceKind::path;
  std::vector<int> points;           ///< training steps, or samples of a plain integrator; ascending
  std::optional<GateMemory> memory;  ///< decides settings.render.cache.memory_bytes when the scene is there

  bool has_cache() const { return renderer::uses_cache(settings.render.integrator); }
};

struct PlannedScene {
  std::string name;
  std::string file;
  std::vector<PlannedSeries> series;
};

/// Each series with each seed.
struct SweepPlan {
  std::vector<PlannedScene> scenes;
  std::vector<std::uint32_t> seeds;

  std::size_t run_count() const;
  std::size_t cell_count() const;
};

/// The series' settings with scene, seed and point.
RenderSettings cell_settings(const PlannedSeries& series, const std::string& scene, std::uint32_t seed,
                             int point);
/// `gatelight render` for it, ready for a shell.
std::string cell_command(const PlannedSeries& series, const std::string& scene, std::uint32_t seed,
                         int point);

}  // namespace gatelight::apps
