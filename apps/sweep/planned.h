#pragma once
// The parts of a plan: scenes, their series of pictures, and the cells of a series.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/settings/parsing.h"
#include "apps/settings/render_settings.h"
#include "apps/sweep/flag_values.h"

namespace gatelight::apps {

/// The kind of reference that a picture is compared with.
enum class ReferenceKind : std::uint8_t {
  path,   ///< radiance
  ao,     ///< ambient occlusion
  cache,  ///< reference of the view of the cache (nrc --view cache)
};
inline constexpr renderer::Choice<ReferenceKind> kReferenceKinds[] = {
    {"path", ReferenceKind::path}, {"ao", ReferenceKind::ao}, {"cache", ReferenceKind::cache}};

/// --cache-memory same-as-gate: as many bytes as this cache takes, over the divisor.
struct GateMemory {
  RenderSettings settings;
  double divisor = 1.0;
};

/// Cells that differ only in seed and step count (or samples, without a cache): a line in a plot. With one
/// seed it is a run: one training, or one rendering.
struct PlannedSeries {
  std::string label;        ///< "nrc gate features 8"
  FlagValues axes;          ///< values of the flags that vary in this sweep, without dashes
  FlagValues flags;         ///< flags of a cell, without seed and point
  RenderSettings settings;  ///< complete except for scene, seed and point
  ReferenceKind reference = ReferenceKind::path;
  std::vector<int> points;           ///< training steps, or samples of a plain integrator; ascending
  std::optional<GateMemory> memory;  ///< decides settings.render.cache.memory_bytes once the scene is loaded
  bool named = false;  ///< a named run: one cell, as `gatelight render` makes it of `flags`; points is {0}

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

/// The name of a cell's row in results.md, the same for all seeds: "path, 16 spp", "nrc gate, 128 steps", or
/// that of a named run.
std::string run_name(const PlannedSeries& series, int point);

/// Decides a named run beside its settings: the choice of the integrator. Empty for other series.
std::string named_text(const PlannedSeries& series);

/// The settings of a cell: those of the series with scene, seed and point.
RenderSettings cell_settings(const PlannedSeries& series, const std::string& scene, std::uint32_t seed,
                             int point);
/// The command `gatelight render ...` of a cell, quoted for a shell.
std::string cell_command(const PlannedSeries& series, const std::string& scene, std::uint32_t seed,
                         int point);

}  // namespace gatelight::apps
