#include "renderer/fingerprint/deciding_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "renderer/settings/enum_names.h"

// Structured bindings name every member of the structs: a new member does not compile until it is decided
// here whether it decides bits.

namespace gatelight::renderer {
namespace {

template <class Dense>
std::string numbers(const Eigen::DenseBase<Dense>& values) {
  std::string text;
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    for (Eigen::Index row = 0; row < values.rows(); ++row)
      text += fmt::format("{}{}", text.empty() ? "" : ",", float{values(row, column)});
  }
  return text;
}

std::string text_of(const View& view) {
  const scene::Camera& camera = view;
  const auto& [name, node, transform, orthographic, vertical_fov, aspect, half_height, half_width] = camera;
  std::string text = fmt::format("{} {}", numbers(transform.matrix()),
                                 orthographic ? fmt::format("orthographic {},{}", half_height, half_width)
                                              : fmt::format("fov {} aspect {}", vertical_fov, aspect));
  if (view.panorama) text += " panorama";
  if (view.lens_radius > 0.0f)
    text += fmt::format(" lens {},{},{}", view.lens_radius, view.focus_distance, view.blades);
  return text;
}

std::string text_of(bool value) {
  return value ? "on" : "off";
}
std::string text_of(const std::string& value) {
  return value;
}
template <class Value>
std::string text_of(const Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    return enum_name(value);
  } else {
    return fmt::format("{}", value);
  }
}

/// The texts of the members that decide bits.
class Texts {
 public:
  template <class Value>
  void add(const char* name, const Value& value) {
    texts_.push_back({name, text_of(value)});
  }
  /// `none` stands for no value.
  template <class Value>
  void add(const char* name, const std::optional<Value>& value, const char* none) {
    texts_.push_back({name, value ? text_of(*value) : none});
  }
  NamedTexts take() { return std::move(texts_); }

 private:
  NamedTexts texts_;
};

void add_self_training(Texts& texts, const SelfTrainingOptions& options) {
  const auto& [start_step, vertices, full_fraction, attenuation] = options;
  texts.add("self-training", start_step);
  texts.add("self-training-vertices", vertices);
  texts.add("self-training-full", full_fraction);
  texts.add("self-training-attenuation", attenuation);
}

void add_training(Texts& texts, const neural::TrainingOptions& options) {
  const auto& [loss, adam, update, feature_step, precision, average, start_at_mean, max_target,
               count_triangles, seed] = options;
  const auto& [learning_rate, beta1, beta2, epsilon, l2_network, decay_steps] = adam;
  const auto& [average_network, average_features, average_decay, average_ramp] = average;
  texts.add("loss", loss);
  texts.add("learning-rate", learning_rate);
  texts.add("beta1", beta1);
  texts.add("beta2", beta2);
  texts.add("epsilon", epsilon);
  texts.add("l2-network", l2_network);
  texts.add("learning-decay", decay_steps);
  texts.add("update", update);
  texts.add("feature-step", feature_step);
  texts.add("feature-precision", precision);
  texts.add("average", average_network);
  texts.add("average-features", average_features);
  texts.add("average-decay", average_decay);
  texts.add("average-ramp", average_ramp);
  texts.add("start-at-mean", start_at_mean);
  texts.add("max-target", max_target);
  texts.add("count-triangles", count_triangles);
  texts.add("training-seed", seed);
}

void add_gate(Texts& texts, const neural::GateOptions& options) {
  const auto& [features, stack, rule, node_spacing, resolution_scale, fixed_resolution, max_resolution,
               storage, cluster, memory_budget, budget_is_cap, bytes_per_feature] = options;
  std::vector<std::string> levels;
  for (const std::uint32_t level : stack) levels.push_back(neural::level_text(level));
  texts.add("features", features);
  texts.add("stack", fmt::format("{}", fmt::join(levels, ",")));
  texts.add("resolution", rule);
  texts.add("gate-node-spacing", node_spacing);
  texts.add("resolution-scale", resolution_scale);
  texts.add("fixed-resolution", fixed_resolution);
  texts.add("max-resolution", max_resolution);
  texts.add("storage", storage);
  texts.add("cluster", cluster);
  texts.add("gate-memory", memory_budget);
  texts.add("gate-memory-is-cap", budget_is_cap);
  texts.add("gate-bytes", bytes_per_feature);
}

void add_hash_grid(Texts& texts, const neural::HashGridOptions& options) {
  const auto& [levels, features, base_resolution, growth, log2_table_size, memory_target, bytes_per_feature,
               bounds_min, bounds_max] = options;
  texts.add("hash-levels", levels);
  texts.add("hash-features", features);
  texts.add("hash-base", base_resolution);
  texts.add("hash-growth", growth);
  texts.add("hash-log2-size", log2_table_size);
  texts.add("hash-memory", memory_target);
  texts.add("hash-bytes", bytes_per_feature);
  texts.add("hash-bounds", fmt::format("{},{}", fmt::join(bounds_min, ","), fmt::join(bounds_max, ",")));
}

/// The time of training and the file that is written decide no bits.
void add_cache(Texts& texts, const CacheOptions& options) {
  [[maybe_unused]] const auto& [train_steps, train_seconds, batch, path_length, samples_per_point, source,
                                samples_from_step, candidates, self_training, node_spacing, encoding, gate,
                                hash_grid, memory_bytes, mlp, training, direction_input, normal_input,
                                albedo_input, scout, holds, query_at, view, min_roughness, spread_threshold,
                                bf16_queries, device, cache_in, cache_out] = options;
  texts.add("train-steps", train_steps, "auto");
  texts.add("batch", batch);
  texts.add("train-path-length", path_length);
  texts.add("samples-per-point", samples_per_point);
  texts.add("training-points", source);
  texts.add("samples-from-step", samples_from_step);
  texts.add("candidates", candidates);
  add_self_training(texts, self_training);
  texts.add("node-spacing", node_spacing, "auto");
  texts.add("encoding", encoding);
  if (encoding == neural::FeatureEncoding::gate) add_gate(texts, gate);
  if (encoding == neural::FeatureEncoding::hash_grid) add_hash_grid(texts, hash_grid);
  texts.add("cache-memory", memory_bytes);
  const auto& [width, hidden_layers, outputs, leaky_slope, biases] = mlp;
  texts.add("hidden", width);
  texts.add("layers", hidden_layers);
  texts.add("outputs", outputs);
  texts.add("leaky-slope", leaky_slope);
  texts.add("bias", biases);
  add_training(texts, training);
  texts.add("direction-input", direction_input, "auto");
  texts.add("normal-input", normal_input, "auto");
  texts.add("albedo-input", albedo_input, "auto");
  texts.add("scout", scout);
  texts.add("cache-holds", holds);
  texts.add("query-at", query_at);
  texts.add("view", view);
  texts.add("cache-roughness", min_roughness);
  texts.add("spread-threshold", spread_threshold);
  texts.add("query-precision", bf16_queries);
  texts.add("device", device);
  texts.add("cache-in", cache_in.empty() ? "none" : cache_in);
}

void add_background(Texts& texts, const BackgroundOptions& options) {
  const auto& [kind, color, file, shadow_catcher] = options;
  texts.add("background", fmt::format("{} {} {}", static_cast<int>(kind), numbers(color), file));
  texts.add("shadow-catcher", shadow_catcher);
}

}  // namespace

// The scene's fingerprint stands for the environment, `view` for the camera, `machine` for the instruction
// set. Cryptomattes are neither in films nor in checkpoints.
NamedTexts deciding_options(const RenderOptions& options, const View& view, const NamedTexts& machine) {
  [[maybe_unused]] const auto& [denoiser, prefilter, supersampling, temporal, library] = options.denoise;
  std::vector<std::string> layers;
  for (const Aov aov : options.aovs) layers.push_back(enum_name(aov));
  Texts texts;
  texts.add("integrator", options.integrator);
  texts.add("size", fmt::format("{}x{}", options.width, options.height));
  texts.add("region", options.region ? fmt::format("{}", fmt::join(*options.region, ",")) : "all");
  texts.add("camera", text_of(view));
  add_plain_members(texts, options);
  texts.add("ao-distance", options.ao_distance < 0.0f ? "auto" : fmt::format("{}", options.ao_distance));
  texts.add("denoiser", denoiser);
  texts.add("prefilter", prefilter);
  texts.add("supersampling", supersampling);
  texts.add("aov", fmt::format("{}", fmt::join(layers, ",")));
  texts.add("light-groups", options.light_groups.empty() ? "none" : text_of(options.light_groups));
  add_background(texts, options.background);
  if (uses_cache(options.integrator)) add_cache(texts, options.cache);
  NamedTexts all = texts.take();
  all.insert(all.end(), machine.begin(), machine.end());
  return all;
}

}  // namespace gatelight::renderer
