#pragma once
// Small random surfaces, models and batches for every configuration that the library allows, to compare
// backends with each other.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/random.h"
#include "neural/model/batch.h"
#include "neural/model/model.h"
#include "neural/model/training_options.h"

namespace gatelight::neural::testing {

struct Random {
  std::uint64_t key = 0;
  std::uint64_t counter = 0;

  float unit() { return uniform_float(key, counter++); }  ///< in [0,1)
  float between(float low, float high) { return low + (high - low) * unit(); }
  std::uint32_t below(std::uint32_t count) {
    return std::min(static_cast<std::uint32_t>(unit() * static_cast<float>(count)), count - 1);
  }
  Float3 direction() {
    const float z = between(-1, 1), phi = between(0, 6.2831853f), r = std::sqrt(std::max(0.0f, 1 - z * z));
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
};

// ---- surfaces

struct OwnedMesh {
  std::vector<Float3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A SurfaceLayout with its data: layout() is valid as long as this lives and does not move.
struct OwnedSurfaces {
  std::vector<OwnedMesh> meshes;
  std::vector<SurfaceInstance> instances;

  SurfaceLayout layout() const {
    SurfaceLayout surfaces;
    for (const OwnedMesh& mesh : meshes) surfaces.meshes.push_back({mesh.positions, mesh.triangles});
    surfaces.instances = instances;
    return surfaces;
  }
};

/// Closed: an octahedron whose triangles are cut in four `subdivisions` times, on the unit sphere.
inline OwnedMesh make_sphere(int subdivisions) {
  OwnedMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int step = 0; step < subdivisions; ++step) {
    std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const std::pair key = std::minmax(a, b);
      const std::pair<std::uint32_t, std::uint32_t> edge{key.first, key.second};
      for (const auto& [known, vertex] : middles)
        if (known == edge) return vertex;
      Float3 sum;
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum[axis] = mesh.positions[a][axis] + mesh.positions[b][axis];
      const float length = std::hypot(sum[0], sum[1], sum[2]);
      for (float& coordinate : sum) coordinate /= length;
      mesh.positions.push_back(sum);
      middles.push_back({edge, static_cast<std::uint32_t>(mesh.positions.size() - 1)});
      return middles.back().second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

/// Open: cells x cells squares of two triangles over [0,1]^2, uneven by `height`.
inline OwnedMesh make_sheet(std::uint32_t cells, float height, std::uint64_t seed) {
  OwnedMesh mesh;
  Random random{seed};
  const std::uint32_t row = cells + 1;
  for (std::uint32_t y = 0; y < row; ++y)
    for (std::uint32_t x = 0; x < row; ++x)
      mesh.positions.push_back({static_cast<float>(x) / static_cast<float>(cells),
                                static_cast<float>(y) / static_cast<float>(cells), height * random.unit()});
  for (std::uint32_t y = 0; y < cells; ++y)
    for (std::uint32_t x = 0; x < cells; ++x) {
      const std::uint32_t a = y * row + x;
      mesh.triangles.push_back({a, a + 1, a + row + 1});
      mesh.triangles.push_back({a + row + 1, a + row, a});
    }
  return mesh;
}

/// Not a manifold: `blades` triangles on one edge, walked in both directions.
inline OwnedMesh make_fan(std::uint32_t blades) {
  OwnedMesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}};
  for (std::uint32_t i = 0; i < blades; ++i) {
    const float angle = 6.2831853f * static_cast<float>(i) / static_cast<float>(blades);
    mesh.positions.push_back({std::cos(angle), std::sin(angle), 0.5f});
    if (i % 2 == 0)
      mesh.triangles.push_back({0, 1, i + 2});
    else
      mesh.triangles.push_back({1, 0, i + 2});
  }
  return mesh;
}

inline std::array<float, 12> scaled_and_moved(float scale, float x, float y, float z) {
  return {scale, 0, 0, 0, scale, 0, 0, 0, scale, x, y, z};
}

/// A sphere, a sheet with both sides, a fan with its back only, a sphere without storage and a tiny sphere
/// with triangles far below a node spacing of 0.3: 139 triangles.
inline std::shared_ptr<const OwnedSurfaces> make_small_surfaces() {
  auto surfaces = std::make_shared<OwnedSurfaces>();
  surfaces->meshes = {make_sphere(1), make_sheet(3, 0.2f, 5), make_fan(3)};
  surfaces->instances = {{0, scaled_and_moved(1, 0, 0, 0), Sides::front},
                         {1, scaled_and_moved(2, 3, 0, 0), Sides::both},
                         {2, scaled_and_moved(1, 0, 3, 0), Sides::back},
                         {0, scaled_and_moved(1, 3, 3, 0), Sides::none},
                         {0, scaled_and_moved(0.02f, 0, 0, 3), Sides::front}};
  return surfaces;
}

// ---- models

struct ModelCase {
  std::string name;  ///< letters, digits and underscores
  std::shared_ptr<const Model> model;
};

inline std::ostream& operator<<(std::ostream& stream, const ModelCase& c) {
  return stream << c.name;
}

/// GATE on the small surfaces, L = 8, two levels, direction as input, 2 x 32, 3 outputs.
inline ModelConfig default_gate_config() {
  ModelConfig config;
  config.encoding = FeatureEncoding::gate;
  config.gate.node_spacing = 0.3f;
  config.auxiliary = composite_inputs({});
  return config;
}

/// The paper's 8 x 4 at base 2, with direction, normal and albedo; tables of 2^10 so that levels hash.
inline ModelConfig default_hash_config() {
  ModelConfig config;
  config.encoding = FeatureEncoding::hash_grid;
  config.hash_grid.log2_table_size = 10;
  config.hash_grid.bounds_min = {-1, -2, -0.5f};
  config.hash_grid.bounds_max = {3, 1, 1.5f};
  config.auxiliary = composite_inputs({true, true, true, false});
  return config;
}

/// Only auxiliary inputs.
inline ModelConfig default_plain_config() {
  ModelConfig config;
  config.encoding = FeatureEncoding::none;
  config.hash_grid.bounds_min = {-1, -2, -0.5f};
  config.hash_grid.bounds_max = {3, 1, 1.5f};
  config.auxiliary = {{InputSource::position, InputEncoding::identity, 0}};
  return config;
}

inline std::vector<std::pair<std::string, ModelConfig>> all_model_configs() {
  std::vector<std::pair<std::string, ModelConfig>> configs;
  const auto add = [&](std::string name, const ModelConfig& config) {
    configs.emplace_back(std::move(name), config);
  };
  const ModelConfig gate = default_gate_config(), hash = default_hash_config(),
                    plain = default_plain_config();

  // The two configurations of the benchmarks.
  add("nrc", gate);
  ModelConfig nao = gate;
  nao.gate.features = 2;
  nao.auxiliary.clear();
  nao.mlp.outputs = 1;
  add("nao", nao);

  for (std::uint32_t features = 1; features <= 16; ++features) {
    ModelConfig c = gate;
    c.gate.features = features;
    add(fmt::format("gate_L{}", features), c);
  }
  const std::vector<std::vector<std::uint32_t>> stacks = {{kAdaptive},    {1},       {3},
                                                          {kAdaptive, 2}, {4, 2, 1}, {kAdaptive, 4, 2, 1}};
  for (const auto& stack : stacks)
    for (const std::uint32_t features : {1u, 2u, 3u, 8u, 16u}) {
      ModelConfig c = gate;
      c.gate.stack = stack;
      c.gate.features = features;
      std::string name = fmt::format("gate_L{}_stack", features);
      for (const std::uint32_t r : stack) name += r == kAdaptive ? "_a" : fmt::format("_{}", r);
      add(name, c);
    }
  const std::vector<std::vector<std::uint32_t>> parts = {{kAdaptive, adaptive_part(4), adaptive_part(16)},
                                                         {adaptive_part(3), 1, kAdaptive, adaptive_part(64)},
                                                         {adaptive_part(64), 3}};
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const std::uint32_t features : {2u, 8u}) {
      ModelConfig c = gate;
      c.gate.stack = parts[i];
      c.gate.features = features;
      add(fmt::format("gate_L{}_cells_{}", features, i), c);
    }
  ModelConfig finest = nao;
  finest.gate.stack = {kMaxResolution};
  add("gate_L2_stack_64", finest);
  for (const std::uint32_t features : {2u, 5u, 8u}) {
    ModelConfig c = gate;
    c.gate.features = features;
    c.gate.storage = NodeStorage::per_triangle;
    c.gate.cluster = false;
    add(fmt::format("gate_L{}_per_triangle", features), c);
    c.gate.stack = {5, kAdaptive, 1};
    add(fmt::format("gate_L{}_per_triangle_stack_5_a_1", features), c);
  }
  for (const auto& [word, rule] :
       {std::pair{"paper", ResolutionRule::paper}, {"fixed", ResolutionRule::fixed}}) {
    ModelConfig c = gate;
    c.gate.rule = rule;
    c.gate.cluster = false;
    add(fmt::format("gate_rule_{}", word), c);
  }
  ModelConfig unclustered = gate;
  unclustered.gate.cluster = false;
  add("gate_unclustered", unclustered);

  for (const std::uint32_t width : {16u, 32u, 64u, 128u})
    for (std::uint32_t layers = 1; layers <= 5; ++layers) {
      ModelConfig c = gate;
      c.mlp.width = width;
      c.mlp.hidden_layers = layers;
      add(fmt::format("mlp_{}x{}", layers, width), c);
      c.mlp.biases = false;
      c.mlp.leaky_slope = 0.2f;
      add(fmt::format("mlp_{}x{}_no_biases", layers, width), c);
    }
  for (std::uint32_t outputs = 1; outputs <= 16; ++outputs) {
    ModelConfig c = gate;
    c.mlp.outputs = outputs;
    add(fmt::format("outputs_{}", outputs), c);
    c.mlp.width = 64;
    c.mlp.biases = false;
    if (outputs % 4 == 1) add(fmt::format("outputs_{}_64_no_biases", outputs), c);
  }
  for (const int percent : {0, 1, 30, 100}) {
    ModelConfig c = gate;
    c.mlp.leaky_slope = static_cast<float>(percent) / 100.0f;
    add(fmt::format("leaky_slope_{}_percent", percent), c);
  }

  constexpr std::pair<const char*, InputSource> kSources[] = {{"position", InputSource::position},
                                                              {"direction", InputSource::direction},
                                                              {"normal", InputSource::normal},
                                                              {"albedo", InputSource::albedo},
                                                              {"roughness", InputSource::roughness}};
  for (const auto& [word, source] : kSources) {
    ModelConfig c = plain;
    c.auxiliary = {{source, InputEncoding::identity, 0}};
    add(fmt::format("plain_{}_identity", word), c);
    for (const std::uint32_t bins : {2u, 8u, 64u}) {
      c.auxiliary = {{source, InputEncoding::one_blob, bins}};
      add(fmt::format("plain_{}_one_blob_{}", word, bins), c);
    }
    for (const std::uint32_t frequencies : {1u, 5u, 16u}) {
      c.auxiliary = {{source, InputEncoding::frequency, frequencies}};
      add(fmt::format("plain_{}_frequency_{}", word, frequencies), c);
    }
    for (ModelConfig with : {gate, hash}) {
      with.auxiliary = {{source, InputEncoding::one_blob, 4}};
      add(fmt::format("{}_with_{}", with.encoding == FeatureEncoding::gate ? "gate" : "hash", word), with);
    }
  }
  const std::vector<AuxiliaryInput> everything = {{InputSource::roughness, InputEncoding::one_blob, 4},
                                                  {InputSource::normal, InputEncoding::identity, 0},
                                                  {InputSource::position, InputEncoding::frequency, 6},
                                                  {InputSource::direction, InputEncoding::one_blob, 16},
                                                  {InputSource::albedo, InputEncoding::identity, 0},
                                                  {InputSource::direction, InputEncoding::identity, 0}};
  for (ModelConfig c : {gate, hash, plain}) {
    c.auxiliary = everything;
    add(fmt::format("{}_with_everything", c.encoding == FeatureEncoding::gate        ? "gate"
                                          : c.encoding == FeatureEncoding::hash_grid ? "hash"
                                                                                     : "plain"),
        c);
  }
  ModelConfig widest = plain;
  widest.auxiliary = {{InputSource::position, InputEncoding::one_blob, 64},
                      {InputSource::roughness, InputEncoding::one_blob, 64}};
  add("plain_256_inputs", widest);
  ModelConfig gate_only = gate;
  gate_only.auxiliary.clear();
  add("gate_only", gate_only);

  for (std::uint32_t features = 1; features <= 16; ++features) {
    ModelConfig c = hash;
    c.hash_grid.features = features;
    add(fmt::format("hash_F{}", features), c);
  }
  for (const std::uint32_t levels : {1u, 2u, 5u, 16u}) {
    ModelConfig c = hash;
    c.hash_grid.levels = levels;
    c.hash_grid.features = 2;
    c.hash_grid.base_resolution = 3;
    c.hash_grid.growth = 1.4f;
    add(fmt::format("hash_{}_levels", levels), c);
  }
  ModelConfig hash_only = hash;
  hash_only.auxiliary.clear();
  add("hash_only", hash_only);
  ModelConfig tiny = hash;
  tiny.hash_grid.log2_table_size = 3;
  tiny.hash_grid.base_resolution = 1;
  add("hash_tables_of_8", tiny);
  ModelConfig odd = hash;  // a table size that is no power of two
  odd.hash_grid.memory_target = 100000;
  add("hash_memory_target", odd);
  return configs;
}

inline ModelCase make_case(std::string name, const ModelConfig& config) {
  static const std::shared_ptr<const OwnedSurfaces> surfaces = make_small_surfaces();
  return {std::move(name), make_model(config, surfaces->layout())};
}

/// Every encoding, L, stack, storage, width, depth, number of outputs, slope, bias and auxiliary input.
inline std::vector<ModelCase> all_model_cases() {
  std::vector<ModelCase> cases;
  for (const auto& [name, config] : all_model_configs()) cases.push_back(make_case(name, config));
  return cases;
}

/// The case of that name among all_model_cases; throws std::out_of_range.
inline ModelCase find_model_case(const std::string& name) {
  for (const auto& [known, config] : all_model_configs())
    if (known == name) return make_case(name, config);
  throw std::out_of_range("no model case " + name);
}

struct OptionsCase {
  std::string name;
  TrainingOptions options;
};

/// Every value of every choice at least once, with and without `per_triangle` for encodings on triangles.
inline std::vector<OptionsCase> all_training_options(const Model& model) {
  std::vector<OptionsCase> cases;
  const auto add = [&](std::string name, auto change) {
    TrainingOptions options;
    change(options);
    cases.push_back({std::move(name), options});
  };
  add("default", [](TrainingOptions&) {});
  add("l2", [](TrainingOptions& o) { o.loss = Loss::l2; });
  add("dense", [](TrainingOptions& o) { o.update = FeatureUpdate::dense; });
  add("fp16_masters", [](TrainingOptions& o) { o.precision = FeaturePrecision::fp16_masters; });
  add("fp16", [](TrainingOptions& o) { o.precision = FeaturePrecision::fp16; });
  add("dense_fp16", [](TrainingOptions& o) {
    o.update = FeatureUpdate::dense;
    o.precision = FeaturePrecision::fp16;
  });
  add("no_averages", [](TrainingOptions& o) { o.average.network = o.average.features = false; });
  add("average_of_features_only", [](TrainingOptions& o) { o.average.network = false; });
  add("steady_rate_and_strong_l2", [](TrainingOptions& o) {
    o.adam.decay_steps = 0;
    o.adam.l2_network = 1e-2f;
  });
  add("start_at_zero", [](TrainingOptions& o) { o.start_at_mean = false; });
  if (model.config.encoding == FeatureEncoding::gate) {
    add("per_triangle", [](TrainingOptions& o) { o.feature_step = FeatureStep::per_triangle; });
    add("count_triangles", [](TrainingOptions& o) { o.count_triangles = true; });
    add("dense_count_triangles", [](TrainingOptions& o) {
      o.update = FeatureUpdate::dense;
      o.count_triangles = true;
    });
  }
  return cases;
}

// ---- batches

enum class Fate : std::uint8_t { accepted, clipped, rejected, unstored };

/// `fates` has the result that a backend must give for each record.
struct OwnedBatch {
  std::vector<std::uint32_t> surfaces, triangles;
  std::vector<Float2> barycentrics;
  std::vector<Float3> positions, directions, normals, albedos;
  std::vector<float> roughnesses;
  std::vector<float> targets;
  std::vector<Fate> fates;

  QueryBatch points() const {
    return {surfaces, triangles, barycentrics, positions,   directions,
            normals,  albedos,   roughnesses,  fates.size()};
  }
  TrainingBatch training() const { return {points(), targets}; }
  std::size_t size() const { return fates.size(); }
  std::uint64_t count(Fate fate) const {
    return static_cast<std::uint64_t>(std::count(fates.begin(), fates.end(), fate));
  }
};

struct BatchOptions {
  /// Shares of the records that get NaN or infinity, lie where nothing is stored, or have a target beyond
  /// 1e9 (finite). Without gate nothing is unstored.
  float nonfinite = 0, unstored = 0, beyond = 0;
  /// Share of barycentrics at corners, on edges and slightly outside: there the precision decides whether a
  /// weight is 0 or 1e-9, and with it whether a node is touched.
  float border = 0;
  float crowded = 0.25f;  ///< share of records on one triangle, so that gradients add up
};

namespace detail {

inline void spoil(OwnedBatch& batch, std::size_t record, std::uint32_t outputs, Random& random) {
  constexpr float kBad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()};
  const float bad = kBad[random.below(3)];
  std::vector<float*> places;
  for (std::uint32_t o = 0; o < outputs; ++o) places.push_back(&batch.targets[record * outputs + o]);
  if (!batch.barycentrics.empty())
    for (float& value : batch.barycentrics[record]) places.push_back(&value);
  for (auto* span : {&batch.positions, &batch.directions, &batch.normals, &batch.albedos})
    if (!span->empty())
      for (float& value : (*span)[record]) places.push_back(&value);
  if (!batch.roughnesses.empty()) places.push_back(&batch.roughnesses[record]);
  *places[random.below(static_cast<std::uint32_t>(places.size()))] = bad;
}

}  // namespace detail

/// Records of points at which the model can be queried; spans that it does not read stay empty.
inline OwnedBatch make_batch(const Model& model, std::size_t size, std::uint64_t seed,
                             const BatchOptions& options = {}) {
  OwnedBatch batch;
  Random random{seed};
  const ModelConfig& config = model.config;
  const bool gate = config.encoding == FeatureEncoding::gate;
  const auto uses = [&](InputSource source) { return uses_input(config, source); };
  std::vector<std::uint32_t> stored, bare;
  for (std::uint32_t s = 0; gate && s < model.gate.surfaces.size(); ++s)
    (model.gate.levels[s * model.gate.stack].resolution > 0 ? stored : bare).push_back(s);

  for (std::size_t r = 0; r < size; ++r) {
    const float draw = random.unit();
    Fate fate = Fate::accepted;
    if (draw < options.nonfinite)
      fate = Fate::rejected;
    else if (draw < options.nonfinite + options.unstored)
      fate = gate ? Fate::unstored : Fate::accepted;
    else if (draw < options.nonfinite + options.unstored + options.beyond)
      fate = Fate::clipped;
    batch.fates.push_back(fate);

    if (gate) {
      std::uint32_t surface = stored[random.below(static_cast<std::uint32_t>(stored.size()))];
      std::uint32_t triangle = random.below(model.gate.surfaces[surface].triangle_count);
      if (random.unit() < options.crowded) {
        surface = stored[0];
        triangle = 0;
      }
      if (fate == Fate::unstored) {
        const std::uint32_t way = random.below(bare.empty() ? 2 : 3);
        if (way == 0) triangle = model.gate.surfaces[surface].triangle_count + random.below(1000);
        if (way == 1)
          surface = static_cast<std::uint32_t>(model.gate.surfaces.size()) + random.below(0x7fffffffu);
        if (way == 2) {
          surface = bare[random.below(static_cast<std::uint32_t>(bare.size()))];
          triangle = 0;
        }
      }
      Float2 b = {random.unit(), random.unit()};
      if (b[0] + b[1] > 1) b = {1 - b[0], 1 - b[1]};
      if (random.unit() < options.border) {
        constexpr Float2 kBorders[] = {
            {0, 0},       {1, 0},          {0, 1},         {0.5f, 0},           {0, 0.5f},
            {0.5f, 0.5f}, {-1e-5f, 0.25f}, {0.5f, -2e-6f}, {0.75f, 0.2500001f}, {1e-40f, 1e-42f}};
        b = kBorders[random.below(static_cast<std::uint32_t>(std::size(kBorders)))];
      }
      batch.surfaces.push_back(surface);
      batch.triangles.push_back(triangle);
      batch.barycentrics.push_back(b);
    }
    if (uses(InputSource::position)) {
      Float3 position;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float low = config.hash_grid.bounds_min[axis], high = config.hash_grid.bounds_max[axis];
        position[axis] = random.between(low - 0.05f * (high - low), high + 0.05f * (high - low));
      }
      batch.positions.push_back(position);
    }
    if (uses(InputSource::direction)) batch.directions.push_back(random.direction());
    if (uses(InputSource::normal)) batch.normals.push_back(random.direction());
    if (uses(InputSource::albedo)) batch.albedos.push_back({random.unit(), random.unit(), random.unit()});
    if (uses(InputSource::roughness)) batch.roughnesses.push_back(random.unit());
    for (std::uint32_t o = 0; o < config.mlp.outputs; ++o)
      batch.targets.push_back(random.between(0.1f, 2.0f));
    if (fate == Fate::rejected) detail::spoil(batch, r, config.mlp.outputs, random);
    if (fate == Fate::clipped)
      batch.targets[r * config.mlp.outputs + random.below(config.mlp.outputs)] =
          random.unit() < 0.5f ? 4e9f : -3e38f;
  }
  return batch;
}

/// The batch without the records that are to be rejected or are unstored.
inline OwnedBatch good_records(const OwnedBatch& batch) {
  OwnedBatch good;
  const std::size_t outputs = batch.size() == 0 ? 0 : batch.targets.size() / batch.size();
  const auto copy = [](auto& to, const auto& from, std::size_t r) {
    if (!from.empty()) to.push_back(from[r]);
  };
  for (std::size_t r = 0; r < batch.size(); ++r) {
    if (batch.fates[r] == Fate::rejected || batch.fates[r] == Fate::unstored) continue;
    copy(good.surfaces, batch.surfaces, r);
    copy(good.triangles, batch.triangles, r);
    copy(good.barycentrics, batch.barycentrics, r);
    copy(good.positions, batch.positions, r);
    copy(good.directions, batch.directions, r);
    copy(good.normals, batch.normals, r);
    copy(good.albedos, batch.albedos, r);
    copy(good.roughnesses, batch.roughnesses, r);
    for (std::size_t o = 0; o < outputs; ++o) good.targets.push_back(batch.targets[r * outputs + o]);
    good.fates.push_back(batch.fates[r]);
  }
  return good;
}

}  // namespace gatelight::neural::testing
