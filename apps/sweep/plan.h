#pragma once
// Which pictures a sweep makes: every combination of its axes, each picture once.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/settings/render_settings.h"
#include "apps/sweep/axes.h"
#include "apps/sweep/flag_values.h"
#include "apps/sweep/scene_names.h"

namespace gatelight::apps {

/// What a picture is compared with.
enum class ReferenceKind : std::uint8_t {
  path,   ///< radiance
  ao,     ///< ambient occlusion
  cache,  ///< what the bare cache should answer (nrc --view cache)
};
Choices<ReferenceKind> reference_kind_choices();

/// Axes that are combined with each other. A sweep of flags has one block; presets have several.
struct SweepBlock {
  std::string row;  ///< name of its line in a table; empty: none
  FlagValues
      base;  ///< holds for all its cells; without --seed, --train-steps and the --spp of plain integrators
  std::vector<SweepAxis> axes;  ///< --spp among them is for integrators with a cache
  std::vector<int> train_steps;
};

struct SweepRequest {
  std::vector<SweepScene> scenes;
  std::vector<SweepBlock> blocks;
  std::vector<int> plain_spp;
  bool allow_external = false;  ///< of all scenes
  bool plain = true;            ///< beside each integrator with a cache the one that it stands in for
  std::uint32_t first_seed = 1;
  int seeds = 1;
};

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

/// Checks every cell; throws UsageError naming the bad value.
SweepPlan make_plan(const SweepRequest& request);

/// The plan for people: --dry-run.
std::string plan_text(const SweepPlan& plan);

}  // namespace gatelight::apps
