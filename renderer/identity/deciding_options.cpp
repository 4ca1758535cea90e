#include "renderer/identity/deciding_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>

#include "renderer/film/film.h"
#include "renderer/settings/option_words.h"

// Structures are taken apart member by member: with one more in the struct this does not compile, and whoever
// adds it decides here.

namespace gatelight::renderer {
namespace {

template <class T>
std::string text(const T& value) {
  return fmt::format("{}", value);
}
std::string text(bool value) {
  return value ? "on" : "off";
}
template <class T>
std::string text(const std::optional<T>& value) {
  return value ? text(*value) : "auto";
}

template <class Dense>
std::string numbers(const Eigen::DenseBase<Dense>& values) {
  std::string text;
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    for (Eigen::Index row = 0; row < values.rows(); ++row)
      text += fmt::format("{}{}", text.empty() ? "" : ",", float{values(row, column)});
  }
  return text;
}

std::string text(const scene::Camera& camera) {
  const auto& [name, transform, orthographic, vertical_fov, aspect, half_height, half_width] = camera;
  return fmt::format("{} {}", numbers(transform.matrix()),
                     orthographic ? fmt::format("orthographic {},{}", half_height, half_width)
                                  : fmt::format("fov {} aspect {}", vertical_fov, aspect));
}

std::string aov_names(const std::vector<Aov>& aovs) {
  std::vector<const char*> names;
  names.reserve(aovs.size());
  for (const Aov aov : aovs) names.push_back(aov_name(aov));
  return fmt::format("{}", fmt::join(names, ","));
}

void add_training_points(NamedTexts& texts, const CacheOptions& options) {
  const auto& [start_step, vertices, full_fraction, attenuation] = options.self_training;
  const NamedTexts more = {{"train-steps", text(options.train_steps)},
                           {"batch", text(options.batch)},
                           {"train-path-length", text(options.path_length)},
                           {"samples-per-point", text(options.samples_per_point)},
                           {"training-points", word(options.source)},
                           {"candidates", text(options.candidates)},
                           {"self-training", text(start_step)},
                           {"self-training-vertices", text(vertices)},
                           {"self-training-full", text(full_fraction)},
                           {"self-training-attenuation", text(attenuation)}};
  texts.insert(texts.end(), more.begin(), more.end());
}

void add_training(NamedTexts& texts, const neural::TrainingOptions& options) {
  const auto& [loss, adam, update, feature_step, precision, average, start_at_mean, max_target,
               count_triangles, seed] = options;
  const auto& [learning_rate, beta1, beta2, epsilon, l2_network, decay_steps] = adam;
  const auto& [average_network, average_features, decay, ramp] = average;
  const NamedTexts more = {{"loss", word(loss)},
                           {"learning-rate", text(learning_rate)},
                           {"beta1", text(beta1)},
                           {"beta2", text(beta2)},
                           {"epsilon", text(epsilon)},
                           {"l2-network", text(l2_network)},
                           {"learning-decay", text(decay_steps)},
                           {"update", word(update)},
                           {"feature-step", word(feature_step)},
                           {"feature-precision", word(precision)},
                           {"average", fmt::format("{},{}", text(average_network), text(average_features))},
                           {"average-decay", text(decay)},
                           {"average-ramp", text(ramp)},
                           {"start-at-mean", text(start_at_mean)},
                           {"max-target", text(max_target)},
                           {"count-triangles", text(count_triangles)},
                           {"training-seed", text(seed)}};
  texts.insert(texts.end(), more.begin(), more.end());
}

void add_gate(NamedTexts& texts, const neural::GateOptions& options) {
  const auto& [features, stack, rule, node_spacing, resolution_scale, fixed_resolution, max_resolution,
               storage, cluster, memory_budget, budget_is_cap, bytes_per_feature] = options;
  const NamedTexts more = {{"features", text(features)},
                           {"stack", stack_text(stack)},
                           {"resolution", word(rule)},
                           {"gate-node-spacing", text(node_spacing)},
                           {"resolution-scale", text(resolution_scale)},
                           {"fixed-resolution", text(fixed_resolution)},
                           {"max-resolution", text(max_resolution)},
                           {"storage", word(storage)},
                           {"cluster", text(cluster)},
                           {"gate-memory", text(memory_budget)},
                           {"gate-memory-is-cap", text(budget_is_cap)},
                           {"gate-bytes", text(bytes_per_feature)}};
  texts.insert(texts.end(), more.begin(), more.end());
}

void add_hash_grid(NamedTexts& texts, const neural::HashGridOptions& options) {
  const auto& [levels, features, base_resolution, growth, log2_table_size, memory_target, bytes_per_feature,
               bounds_min, bounds_max] = options;
  const NamedTexts more = {
      {"hash-levels", text(levels)},
      {"hash-features", text(features)},
      {"hash-base", text(base_resolution)},
      {"hash-growth", text(growth)},
      {"hash-log2-size", text(log2_table_size)},
      {"hash-memory", text(memory_target)},
      {"hash-bytes", text(bytes_per_feature)},
      {"hash-bounds", fmt::format("{},{}", fmt::join(bounds_min, ","), fmt::join(bounds_max, ","))}};
  texts.insert(texts.end(), more.begin(), more.end());
}

void add_cache(NamedTexts& texts, const CacheOptions& options) {
  const auto& [train_steps, train_seconds, batch, path_length, samples_per_point, source, candidates,
               self_training, node_spacing, encoding, gate, hash_grid, memory_bytes, mlp, training,
               direction_input, normal_input, albedo_input, scout, holds, query_at, view, min_roughness,
               spread_threshold, bf16_queries, device, cache_in, cache_out] = options;
  const auto& [width, hidden_layers, outputs, leaky_slope, biases] = mlp;
  add_training_points(texts, options);
  add_training(texts, training);
  texts.push_back({"encoding", word(encoding)});
  if (encoding == neural::FeatureEncoding::hash_grid) {
    add_hash_grid(texts, hash_grid);
  } else {
    add_gate(texts, gate);
  }
  const NamedTexts more = {{"node-spacing", text(node_spacing)},
                           {"cache-memory", text(memory_bytes)},
                           {"hidden", text(width)},
                           {"layers", text(hidden_layers)},
                           {"outputs", text(outputs)},
                           {"leaky-slope", text(leaky_slope)},
                           {"bias", text(biases)},
                           {"direction-input", text(direction_input)},
                           {"normal-input", text(normal_input)},
                           {"albedo-input", text(albedo_input)},
                           {"scout", text(scout)},
                           {"cache-holds", word(holds)},
                           {"query-at", word(query_at)},
                           {"view", word(view)},
                           {"cache-roughness", text(min_roughness)},
                           {"spread-threshold", text(spread_threshold)},
                           {"query-precision", bf16_queries ? "bf16" : "fp32"},
                           {"device", device},
                           {"cache-in", cache_in.empty() ? "none" : cache_in}};
  texts.insert(texts.end(), more.begin(), more.end());
}

}  // namespace

NamedTexts deciding_options(const RenderOptions& options, const scene::Camera& camera,
                            const NamedTexts& machine) {
  // The environment is in the scene's fingerprint, the camera is the chosen one.
  const auto& [integrator, width, height, region, spp, time_limit_seconds, max_depth, min_depth, seed,
               threads, sampler, filter, filter_width, mis, direct, light_selection, clamp, ao_distance, aovs,
               nan_policy, memory_limit_bytes, isa, camera_options, environment, cache, checkpoint] = options;
  NamedTexts texts = {{"integrator", word(integrator)},
                      {"size", fmt::format("{}x{}", width, height)},
                      {"region", region ? fmt::format("{}", fmt::join(*region, ",")) : "all"},
                      {"camera", text(camera)},
                      {"seed", text(seed)},
                      {"max-depth", text(max_depth)},
                      {"min-depth", text(min_depth)},
                      {"sampler", word(sampler)},
                      {"filter", word(filter)},
                      {"filter-width", text(filter_width)},
                      {"mis", word(mis)},
                      {"direct", word(direct)},
                      {"light-selection", word(light_selection)},
                      {"clamp", text(clamp)},
                      {"ao-distance", ao_distance < 0.0f ? "auto" : text(ao_distance)},
                      {"aov", aov_names(aovs)}};
  if (uses_cache(integrator)) add_cache(texts, cache);
  texts.insert(texts.end(), machine.begin(), machine.end());
  return texts;
}

}  // namespace gatelight::renderer
