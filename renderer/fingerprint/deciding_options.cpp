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
// here, or beside its struct in renderer/settings, whether it decides bits.

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
  if (!(view.clip == Clip{})) text += fmt::format(" clip {},{}", view.clip.near, view.clip.far);
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
  void add(const neural::GateOptions& options);
  void add(const neural::HashGridOptions& options);
  void add(const neural::TrainingOptions& options);
  /// `none` stands for no value.
  template <class Value>
  void add(const char* name, const std::optional<Value>& value, const char* none) {
    texts_.push_back({name, value ? text_of(*value) : none});
  }
  NamedTexts take() { return std::move(texts_); }

 private:
  NamedTexts texts_;
};

void Texts::add(const neural::TrainingOptions& options) {
  const auto& [loss, adam, update, feature_step, precision, average, start_at_mean, max_target,
               count_triangles, seed] = options;
  const auto& [learning_rate, beta1, beta2, epsilon, l2_network, decay_steps] = adam;
  const auto& [average_network, average_features, average_decay, average_ramp] = average;
  add("loss", loss);
  add("learning-rate", learning_rate);
  add("beta1", beta1);
  add("beta2", beta2);
  add("epsilon", epsilon);
  add("l2-network", l2_network);
  add("learning-decay", decay_steps);
  add("update", update);
  add("feature-step", feature_step);
  add("feature-precision", precision);
  add("average", average_network);
  add("average-features", average_features);
  add("average-decay", average_decay);
  add("average-ramp", average_ramp);
  add("start-at-mean", start_at_mean);
  add("max-target", max_target);
  add("count-triangles", count_triangles);
  add("training-seed", seed);
}

void Texts::add(const neural::GateOptions& options) {
  const auto& [features, stack, rule, node_spacing, resolution_scale, fixed_resolution, max_resolution,
               storage, cluster, memory_budget, budget_is_cap, bytes_per_feature] = options;
  add("features", features);
  add("stack", neural::stack_text(stack));
  add("resolution", rule);
  add("gate-node-spacing", node_spacing);
  add("resolution-scale", resolution_scale);
  add("fixed-resolution", fixed_resolution);
  add("max-resolution", max_resolution);
  add("storage", storage);
  add("cluster", cluster);
  add("gate-memory", memory_budget);
  add("gate-memory-is-cap", budget_is_cap);
  add("gate-bytes", bytes_per_feature);
}

void Texts::add(const neural::HashGridOptions& options) {
  const auto& [levels, features, base_resolution, growth, log2_table_size, memory_target, bytes_per_feature,
               bounds_min, bounds_max] = options;
  add("hash-levels", levels);
  add("hash-features", features);
  add("hash-base", base_resolution);
  add("hash-growth", growth);
  add("hash-log2-size", log2_table_size);
  add("hash-memory", memory_target);
  add("hash-bytes", bytes_per_feature);
  add("hash-bounds", fmt::format("{},{}", fmt::join(bounds_min, ","), fmt::join(bounds_max, ",")));
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
  [[maybe_unused]] const auto& [denoiser, prefilter, supersampling, temporal, parts, library] =
      options.denoise;
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
  texts.add("denoise-parts", parts);
  texts.add("aov", fmt::format("{}", fmt::join(layers, ",")));
  texts.add("light-groups", options.light_groups.empty() ? "none" : text_of(options.light_groups));
  add_background(texts, options.background);
  if (uses_cache(options.integrator)) add_plain_members(texts, options.cache);
  NamedTexts all = texts.take();
  all.insert(all.end(), machine.begin(), machine.end());
  return all;
}

}  // namespace gatelight::renderer
