#pragma once
// A plan of one scene, what a cell of it measured, and the reading of results.csv.

#include <limits>
#include <string>
#include <vector>

#include "apps/sweep/cell_record.h"
#include "apps/sweep/request.h"

namespace gatelight::apps {

/// Of a sweep of one scene.
inline SweepArguments arguments(FlagValues base = {}, std::vector<std::string> vary = {},
                                const std::string& train_steps = "") {
  SweepArguments words;
  words.scenes = {"room.glb"};
  words.base = std::move(base);
  words.vary = std::move(vary);
  words.train_steps = train_steps;
  return words;
}

inline SweepPlan plan_from(const SweepArguments& words) {
  return make_plan(make_request(words));
}

inline const SweepPlan& small_plan() {
  static const SweepPlan plan = [] {
    SweepArguments words = arguments({}, {"stack=adaptive,1;adaptive"}, "4,8");
    words.scenes = {"a, \"b\".glb"};
    return plan_from(words);
  }();
  return plan;
}

/// A cell of the series with a cache.
inline CellPlace cached(const std::string& id = "0123", int steps = 8, std::uint32_t seed = 1) {
  const PlannedScene& scene = small_plan().scenes[0];
  return {scene, scene.series[0], seed, steps, id, "ref"};
}
/// A cell of the paths beside it.
inline CellPlace traced(const std::string& id = "0123", int spp = 16) {
  const PlannedScene& scene = small_plan().scenes[0];
  return {scene, scene.series[1], 1, spp, id, "ref"};
}

/// Of the series of the first scene.
inline std::vector<std::string> labels(const SweepPlan& plan) {
  std::vector<std::string> labels;
  for (const PlannedSeries& series : plan.scenes[0].series) labels.push_back(series.label);
  return labels;
}

inline renderer::RenderStatistics statistics() {
  renderer::RenderStatistics s;
  s.render_seconds = 0.25;
  s.cache.scout_seconds = 0.5;
  s.cache.setup_seconds = 1.0;
  s.cache.train_seconds = 2.0;
  s.cache.train_step_seconds = 0.8;
  s.cache.steps = 8;
  s.cache.queries = 1000;
  s.cache.render_query_seconds = 0.001;
  s.cache.parameter_bytes = 123;
  s.cache.loss = 0.5;
  s.cache.normal_input = true;
  s.cache.node_spacing = 0.1f;
  s.cache.backend = "cpu avx2";
  s.isa = "avx2";
  return s;
}

inline CompareReport errors() {
  CompareReport e;
  e.errors.mse = 0.01;
  e.errors.rel_mse = 0.02;
  e.errors.psnr = std::numeric_limits<double>::infinity();
  e.rel_mse_clean = 0.015;
  e.ssim = 0.9;
  e.flip.emplace();
  e.flip->summary = {.mean = 0.1, .weighted_median = 0.3, .first_quartile = 0.2, .third_quartile = 0.4};
  return e;
}

inline nlohmann::ordered_json done(const CellPlace& place, bool pictures = true) {
  return done_record(place, statistics(), errors(), pictures, 2.5f);
}

/// Fields of lines, quotes as in RFC 4180.
inline std::vector<std::vector<std::string>> read_csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows(1, {""});
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (quoted && c == '"' && text[i + 1] == '"') {
      rows.back().back() += text[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && c == ',') {
      rows.back().emplace_back();
    } else if (!quoted && c == '\n') {
      rows.push_back({""});
    } else {
      rows.back().back() += c;
    }
  }
  rows.pop_back();
  return rows;
}

}  // namespace gatelight::apps
