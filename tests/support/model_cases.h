#pragma once
// Models of every configuration that the library allows, on small surfaces, and every choice of training
// options, to compare backends with each other.

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "neural/model/model.h"
#include "neural/model/training_options.h"
#include "tests/support/small_surfaces.h"

namespace gatelight::neural::testing {

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

/// Models by their names of letters, digits and underscores.
using NamedConfigs = std::vector<std::pair<std::string, ModelConfig>>;

namespace detail {

/// The second configuration of the benchmarks.
inline ModelConfig occlusion_config() {
  ModelConfig config = default_gate_config();
  config.gate.features = 2;
  config.auxiliary.clear();
  config.mlp.outputs = 1;
  return config;
}

/// Every number of features, with stacks of fixed, adaptive and divided resolutions.
inline void add_stacks(NamedConfigs& configs) {
  const ModelConfig gate = default_gate_config();
  for (std::uint32_t features = 1; features <= 16; ++features) {
    ModelConfig c = gate;
    c.gate.features = features;
    configs.emplace_back(fmt::format("gate_L{}", features), c);
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
      configs.emplace_back(name, c);
    }
  const std::vector<std::vector<std::uint32_t>> parts = {{kAdaptive, adaptive_part(4), adaptive_part(16)},
                                                         {adaptive_part(3), 1, kAdaptive, adaptive_part(64)},
                                                         {adaptive_part(64), 3}};
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const std::uint32_t features : {2u, 8u}) {
      ModelConfig c = gate;
      c.gate.stack = parts[i];
      c.gate.features = features;
      configs.emplace_back(fmt::format("gate_L{}_cells_{}", features, i), c);
    }
  ModelConfig finest = occlusion_config();
  finest.gate.stack = {kMaxResolution};
  configs.emplace_back("gate_L2_stack_64", finest);
}

/// Every storage and rule of resolution.
inline void add_storages(NamedConfigs& configs) {
  const ModelConfig gate = default_gate_config();
  for (const std::uint32_t features : {2u, 5u, 8u}) {
    ModelConfig c = gate;
    c.gate.features = features;
    c.gate.storage = NodeStorage::per_triangle;
    c.gate.cluster = false;
    configs.emplace_back(fmt::format("gate_L{}_per_triangle", features), c);
    c.gate.stack = {5, kAdaptive, 1};
    configs.emplace_back(fmt::format("gate_L{}_per_triangle_stack_5_a_1", features), c);
  }
  for (const auto& [word, rule] :
       {std::pair{"paper", ResolutionRule::paper}, {"fixed", ResolutionRule::fixed}}) {
    ModelConfig c = gate;
    c.gate.rule = rule;
    c.gate.cluster = false;
    configs.emplace_back(fmt::format("gate_rule_{}", word), c);
  }
  ModelConfig unclustered = gate;
  unclustered.gate.cluster = false;
  configs.emplace_back("gate_unclustered", unclustered);
}

/// Every width, depth, number of outputs and slope, with and without biases.
inline void add_networks(NamedConfigs& configs) {
  const ModelConfig gate = default_gate_config();
  for (const std::uint32_t width : {16u, 32u, 64u, 128u})
    for (std::uint32_t layers = 1; layers <= 5; ++layers) {
      ModelConfig c = gate;
      c.mlp.width = width;
      c.mlp.hidden_layers = layers;
      configs.emplace_back(fmt::format("mlp_{}x{}", layers, width), c);
      c.mlp.biases = false;
      c.mlp.leaky_slope = 0.2f;
      configs.emplace_back(fmt::format("mlp_{}x{}_no_biases", layers, width), c);
    }
  for (std::uint32_t outputs = 1; outputs <= 16; ++outputs) {
    ModelConfig c = gate;
    c.mlp.outputs = outputs;
    configs.emplace_back(fmt::format("outputs_{}", outputs), c);
    c.mlp.width = 64;
    c.mlp.biases = false;
    if (outputs % 4 == 1) configs.emplace_back(fmt::format("outputs_{}_64_no_biases", outputs), c);
  }
  for (const int percent : {0, 1, 30, 100}) {
    ModelConfig c = gate;
    c.mlp.leaky_slope = static_cast<float>(percent) / 100.0f;
    configs.emplace_back(fmt::format("leaky_slope_{}_percent", percent), c);
  }
}

/// Every auxiliary input in every encoding, alone and with the others.
inline void add_inputs(NamedConfigs& configs) {
  const ModelConfig gate = default_gate_config(), hash = default_hash_config(),
                    plain = default_plain_config();
  constexpr std::pair<const char*, InputSource> kSources[] = {{"position", InputSource::position},
                                                              {"direction", InputSource::direction},
                                                              {"normal", InputSource::normal},
                                                              {"albedo", InputSource::albedo},
                                                              {"roughness", InputSource::roughness}};
  for (const auto& [word, source] : kSources) {
    ModelConfig c = plain;
    c.auxiliary = {{source, InputEncoding::identity, 0}};
    configs.emplace_back(fmt::format("plain_{}_identity", word), c);
    for (const std::uint32_t bins : {2u, 8u, 64u}) {
      c.auxiliary = {{source, InputEncoding::one_blob, bins}};
      configs.emplace_back(fmt::format("plain_{}_one_blob_{}", word, bins), c);
    }
    for (const std::uint32_t frequencies : {1u, 5u, 16u}) {
      c.auxiliary = {{source, InputEncoding::frequency, frequencies}};
      configs.emplace_back(fmt::format("plain_{}_frequency_{}", word, frequencies), c);
    }
    for (ModelConfig with : {gate, hash}) {
      with.auxiliary = {{source, InputEncoding::one_blob, 4}};
      configs.emplace_back(
          fmt::format("{}_with_{}", with.encoding == FeatureEncoding::gate ? "gate" : "hash", word), with);
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
    configs.emplace_back(
        fmt::format("{}_with_everything", c.encoding == FeatureEncoding::gate        ? "gate"
                                          : c.encoding == FeatureEncoding::hash_grid ? "hash"
                                                                                     : "plain"),
        c);
  }
  ModelConfig widest = plain;
  widest.auxiliary = {{InputSource::position, InputEncoding::one_blob, 64},
                      {InputSource::roughness, InputEncoding::one_blob, 64}};
  configs.emplace_back("plain_256_inputs", widest);
  ModelConfig gate_only = gate;
  gate_only.auxiliary.clear();
  configs.emplace_back("gate_only", gate_only);
}

/// Every shape of a hash grid.
inline void add_hash_grids(NamedConfigs& configs) {
  const ModelConfig hash = default_hash_config();
  for (std::uint32_t features = 1; features <= 16; ++features) {
    ModelConfig c = hash;
    c.hash_grid.features = features;
    configs.emplace_back(fmt::format("hash_F{}", features), c);
  }
  for (const std::uint32_t levels : {1u, 2u, 5u, 16u}) {
    ModelConfig c = hash;
    c.hash_grid.levels = levels;
    c.hash_grid.features = 2;
    c.hash_grid.base_resolution = 3;
    c.hash_grid.growth = 1.4f;
    configs.emplace_back(fmt::format("hash_{}_levels", levels), c);
  }
  ModelConfig hash_only = hash;
  hash_only.auxiliary.clear();
  configs.emplace_back("hash_only", hash_only);
  ModelConfig tiny = hash;
  tiny.hash_grid.log2_table_size = 3;
  tiny.hash_grid.base_resolution = 1;
  configs.emplace_back("hash_tables_of_8", tiny);
  ModelConfig odd = hash;  // a table size that is no power of two
  odd.hash_grid.memory_target = 100000;
  configs.emplace_back("hash_memory_target", odd);
}

}  // namespace detail

/// The two configurations of the benchmarks come first.
inline NamedConfigs all_model_configs() {
  NamedConfigs configs = {{"nrc", default_gate_config()}, {"nao", detail::occlusion_config()}};
  detail::add_stacks(configs);
  detail::add_storages(configs);
  detail::add_networks(configs);
  detail::add_inputs(configs);
  detail::add_hash_grids(configs);
  ModelConfig apart = detail::occlusion_config();
  apart.gate.stack = {kMaxResolution};
  apart.gate.storage = NodeStorage::per_triangle;
  apart.gate.cluster = false;
  configs.emplace_back("gate_L2_per_triangle_stack_64", apart);
  return configs;
}

struct ModelCase {
  std::string name;  ///< letters, digits and underscores
  std::shared_ptr<const Model> model;
};

inline std::ostream& operator<<(std::ostream& stream, const ModelCase& c) {
  return stream << c.name;
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

}  // namespace gatelight::neural::testing
