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

/// Adds a variant of a configuration.
template <class Change>
void add(NamedConfigs& configs, std::string name, ModelConfig config, const Change& change) {
  change(config);
  configs.emplace_back(std::move(name), std::move(config));
}

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
  using Stack = std::vector<std::uint32_t>;
  const auto add_stack = [&](const std::string& name, std::uint32_t features, const Stack& stack) {
    add(configs, fmt::format("gate_L{}{}", features, name), default_gate_config(), [&](ModelConfig& c) {
      c.gate.features = features;
      if (!stack.empty()) c.gate.stack = stack;
    });
  };
  for (std::uint32_t features = 1; features <= 16; ++features) add_stack("", features, {});
  for (const Stack& stack :
       std::vector<Stack>{{kAdaptive}, {1}, {3}, {kAdaptive, 2}, {4, 2, 1}, {kAdaptive, 4, 2, 1}}) {
    std::string name = "_stack";
    for (const std::uint32_t r : stack) name += r == kAdaptive ? "_a" : fmt::format("_{}", r);
    for (const std::uint32_t features : {1u, 2u, 3u, 8u, 16u}) add_stack(name, features, stack);
  }
  const std::vector<Stack> parts = {{kAdaptive, adaptive_part(4), adaptive_part(16)},
                                    {adaptive_part(3), 1, kAdaptive, adaptive_part(64)},
                                    {adaptive_part(64), 3}};
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (const std::uint32_t features : {2u, 8u}) add_stack(fmt::format("_cells_{}", i), features, parts[i]);
  add(configs, "gate_L2_stack_64", occlusion_config(),
      [](ModelConfig& c) { c.gate.stack = {kMaxResolution}; });
}

/// Every storage and rule of resolution.
inline void add_storages(NamedConfigs& configs) {
  ModelConfig gate = default_gate_config();
  gate.gate.cluster = false;
  for (const std::uint32_t features : {2u, 5u, 8u}) {
    ModelConfig c = gate;
    c.gate.features = features;
    c.gate.storage = NodeStorage::per_triangle;
    configs.emplace_back(fmt::format("gate_L{}_per_triangle", features), c);
    c.gate.stack = {5, kAdaptive, 1};
    configs.emplace_back(fmt::format("gate_L{}_per_triangle_stack_5_a_1", features), c);
  }
  add(configs, "gate_rule_paper", gate, [](ModelConfig& c) { c.gate.rule = ResolutionRule::paper; });
  add(configs, "gate_rule_fixed", gate, [](ModelConfig& c) { c.gate.rule = ResolutionRule::fixed; });
  configs.emplace_back("gate_unclustered", gate);
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
  for (const int percent : {0, 1, 30, 100})
    add(configs, fmt::format("leaky_slope_{}_percent", percent), gate,
        [&](ModelConfig& c) { c.mlp.leaky_slope = static_cast<float>(percent) / 100.0f; });
}

/// Every auxiliary input in every encoding, alone and with the others.
inline void add_inputs(NamedConfigs& configs) {
  const std::pair<const char*, ModelConfig> encodings[] = {
      {"gate", default_gate_config()}, {"hash", default_hash_config()}, {"plain", default_plain_config()}};
  const auto add_with = [&](const std::string& name, const ModelConfig& config,
                            const std::vector<AuxiliaryInput>& inputs) {
    add(configs, name, config, [&](ModelConfig& c) { c.auxiliary = inputs; });
  };
  const ModelConfig& plain = encodings[2].second;
  constexpr std::pair<const char*, InputSource> kSources[] = {{"position", InputSource::position},
                                                              {"direction", InputSource::direction},
                                                              {"normal", InputSource::normal},
                                                              {"albedo", InputSource::albedo},
                                                              {"roughness", InputSource::roughness}};
  for (const auto& [word, source] : kSources) {
    add_with(fmt::format("plain_{}_identity", word), plain, {{source, InputEncoding::identity, 0}});
    for (const std::uint32_t bins : {2u, 8u, 64u})
      add_with(fmt::format("plain_{}_one_blob_{}", word, bins), plain,
               {{source, InputEncoding::one_blob, bins}});
    for (const auto& [name, config] : {encodings[0], encodings[1]})
      add_with(fmt::format("{}_with_{}", name, word), config, {{source, InputEncoding::one_blob, 4}});
  }
  for (const auto& [name, config] : encodings)
    add_with(fmt::format("{}_with_everything", name), config,
             {{InputSource::roughness, InputEncoding::one_blob, 4},
              {InputSource::normal, InputEncoding::identity, 0},
              {InputSource::position, InputEncoding::one_blob, 8},
              {InputSource::direction, InputEncoding::one_blob, 16},
              {InputSource::albedo, InputEncoding::identity, 0},
              {InputSource::direction, InputEncoding::identity, 0}});
  add_with("plain_256_inputs", plain,
           {{InputSource::position, InputEncoding::one_blob, 64},
            {InputSource::roughness, InputEncoding::one_blob, 64}});
  add_with("gate_only", encodings[0].second, {});
}

/// Every shape of a hash grid.
inline void add_hash_grids(NamedConfigs& configs) {
  const ModelConfig hash = default_hash_config();
  for (std::uint32_t features = 1; features <= 16; ++features)
    add(configs, fmt::format("hash_F{}", features), hash,
        [&](ModelConfig& c) { c.hash_grid.features = features; });
  for (const std::uint32_t levels : {1u, 2u, 5u, 16u})
    add(configs, fmt::format("hash_{}_levels", levels), hash, [&](ModelConfig& c) {
      c.hash_grid.levels = levels;
      c.hash_grid.features = 2;
      c.hash_grid.base_resolution = 3;
      c.hash_grid.growth = 1.4f;
    });
  add(configs, "hash_only", hash, [](ModelConfig& c) { c.auxiliary.clear(); });
  add(configs, "hash_tables_of_8", hash, [](ModelConfig& c) {
    c.hash_grid.log2_table_size = 3;
    c.hash_grid.base_resolution = 1;
  });
  // A table size that is no power of two.
  add(configs, "hash_memory_target", hash, [](ModelConfig& c) { c.hash_grid.memory_target = 100000; });
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
  detail::add(configs, "gate_L2_per_triangle_stack_64", detail::occlusion_config(), [](ModelConfig& c) {
    c.gate.stack = {kMaxResolution};
    c.gate.storage = NodeStorage::per_triangle;
    c.gate.cluster = false;
  });
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
