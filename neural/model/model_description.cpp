#include "neural/model/model_description.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "base/random.h"

namespace gatelight::neural {

namespace {

using nlohmann::ordered_json;

/// The shortest decimal number that rounds to this float; a text if it is not finite, since JSON has no such
/// numbers.
ordered_json number(float value) {
  const std::string text = fmt::format("{}", value);
  return std::isfinite(value) ? ordered_json::parse(text) : ordered_json(text);
}

/// The name of an enumerator; `words` are in the order of the enumeration.
template <class Enumeration>
const char* word(Enumeration value, std::initializer_list<const char*> words) {
  return words.begin()[static_cast<std::size_t>(value)];
}

const char* name(FeatureEncoding encoding) {
  return word(encoding, {"none", "gate", "hash_grid"});
}

const char* name(InputSource source) {
  return word(source, {"position", "direction", "normal", "albedo", "roughness"});
}

const char* name(InputEncoding encoding) {
  return word(encoding, {"identity", "one_blob"});
}

const char* name(ResolutionRule rule) {
  return word(rule, {"uniform", "paper", "fixed"});
}

const char* name(FeaturePrecision precision) {
  return word(precision, {"fp32", "fp16_masters", "fp16"});
}

/// The texts of items, with commas between them. (Clang 14 cannot compile the views of this standard
/// library.)
template <class Items, class Text>
std::string joined(const Items& items, const Text& text) {
  std::vector<std::string> texts;
  for (const auto& item : items) texts.push_back(text(item));
  return fmt::format("{}", fmt::join(texts, ", "));
}

/// "direction one_blob 4, albedo identity"
std::string inputs_text(std::span<const AuxiliaryInput> inputs) {
  const auto text = [](const AuxiliaryInput& input) {
    const std::string words = fmt::format("{} {}", name(input.source), name(input.encoding));
    return input.encoding == InputEncoding::identity ? words : fmt::format("{} {}", words, input.size);
  };
  return joined(inputs, text);
}

class Digest {
 public:
  template <class T>
  void add(const T& value) {
    static_assert(std::has_unique_object_representations_v<T> || std::is_same_v<T, float>);
    add_bytes(std::as_bytes(std::span(&value, 1)));
  }
  template <class Values>
  void add_all(const Values& values) {
    const std::span all(values);
    static_assert(std::has_unique_object_representations_v<typename decltype(all)::value_type>,
                  "padding would be hashed");
    add(std::uint64_t{all.size()});
    add_bytes(std::as_bytes(all));
  }
  std::string text() const { return fmt::format("{:016x}", state_); }

 private:
  void add_bytes(std::span<const std::byte> bytes) {
    for (std::size_t i = 0; i < bytes.size(); i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + i, std::min<std::size_t>(8, bytes.size() - i));
      state_ = mix_bits(state_ ^ word);
    }
  }

  std::uint64_t state_ = 0;
};

void describe_gate(const Model& model, ordered_json& out) {
  const GateOptions& options = model.config.gate;
  out["storage"] = options.storage == NodeStorage::shared ? "shared" : "per_triangle";
  out["stack"] = joined(options.stack, level_text);  // "adaptive, adaptive/4, 1"
  out["rule"] = name(options.rule);
  if (options.rule == ResolutionRule::uniform) out["node_spacing"] = number(model.gate.report.node_spacing);
  if (options.rule == ResolutionRule::paper)
    out["resolution_scale"] = number(model.gate.report.resolution_scale);
  if (options.rule == ResolutionRule::fixed) out["fixed_resolution"] = options.fixed_resolution;
  out["max_resolution"] = options.max_resolution;
  out["cluster"] = options.cluster;
  out["memory_budget"] = options.memory_budget;
  out["surfaces"] = model.gate.surfaces.size();
  out["triangles"] = model.gate.triangle_count;
}

void describe_hash_grid(const Model& model, ordered_json& out) {
  const HashGridOptions& options = model.config.hash_grid;
  out["base_resolution"] = options.base_resolution;
  out["growth"] = number(options.growth);
  out["log2_table_size"] = options.log2_table_size;
  out["memory_target"] = options.memory_target;
}

void describe_bounds(const HashGridOptions& options, ordered_json& out) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char letter = static_cast<char>('x' + axis);
    out[fmt::format("bounds_min_{}", letter)] = number(options.bounds_min[axis]);
    out[fmt::format("bounds_max_{}", letter)] = number(options.bounds_max[axis]);
  }
}

}  // namespace

ordered_json describe_network(const Model& model) {
  const MlpOptions& mlp = model.config.mlp;
  ordered_json out;
  out["encoding"] = name(model.config.encoding);
  out["levels"] = model.levels();
  out["features"] = model.parameters.features;
  out["inputs"] = inputs_text(model.config.auxiliary);
  out["hidden_width"] = mlp.width;
  out["hidden_layers"] = mlp.hidden_layers;
  out["outputs"] = mlp.outputs;
  out["leaky_slope"] = number(mlp.leaky_slope);
  out["biases"] = mlp.biases;
  return out;
}

ordered_json describe_layout(const Model& model) {
  ordered_json out = ordered_json::object();
  if (model.config.encoding == FeatureEncoding::gate) describe_gate(model, out);
  if (model.config.encoding == FeatureEncoding::hash_grid) describe_hash_grid(model, out);
  if (uses_input(model.config, InputSource::position)) describe_bounds(model.config.hash_grid, out);
  out["nodes"] = model.parameters.node_count;
  return out;
}

ordered_json describe_arrays(const TrainingOptions& options) {
  ordered_json out;
  out["feature_precision"] = name(options.precision);
  out["feature_update"] = options.update == FeatureUpdate::sparse ? "sparse" : "dense";
  out["triangle_counts"] = options.counts_triangles();
  out["average_of_network"] = options.average.network;
  out["average_of_features"] = options.average.features;
  return out;
}

ordered_json describe_training(const TrainingOptions& options) {
  ordered_json out;
  out["loss"] = options.loss == Loss::l2 ? "l2" : "relative_l2";
  out["learning_rate"] = number(options.adam.learning_rate);
  out["beta1"] = number(options.adam.beta1);
  out["beta2"] = number(options.adam.beta2);
  out["epsilon"] = number(options.adam.epsilon);
  out["l2_network"] = number(options.adam.l2_network);
  out["decay_steps"] = number(options.adam.decay_steps);
  out["feature_step"] = options.feature_step == FeatureStep::per_node ? "per_node" : "per_triangle";
  out["average_decay"] = number(options.average.decay);
  out["average_ramp"] = number(options.average.ramp);
  out["start_at_mean"] = options.start_at_mean;
  out["max_target"] = number(options.max_target);
  out["seed"] = options.seed;
  return out;
}

std::string layout_digest(const Model& model) {
  Digest digest;
  if (model.config.encoding == FeatureEncoding::gate) {
    const GateLayout& gate = model.gate;
    for (const std::uint32_t value :
         {gate.features, gate.stack, std::uint32_t{gate.storage == NodeStorage::per_triangle},
          gate.node_count, gate.triangle_count})
      digest.add(value);
    digest.add_all(gate.surfaces);
    digest.add_all(gate.levels);
    digest.add_all(gate.topology);
  }
  const HashGridLayout& grid = model.hash_grid;
  digest.add(grid.features);
  digest.add(grid.node_count);
  for (const HashGridLevel& level : grid.levels) {
    digest.add(level.scale);
    for (const std::uint32_t value : {level.resolution, level.entries, level.first_node, level.dense})
      digest.add(value);
  }
  for (const float value : grid.bounds_min) digest.add(value);
  digest.add(grid.inverse_extent);
  return digest.text();
}

std::string list_differences(const ordered_json& file, const ordered_json& model) {
  std::string text;
  const auto add = [&](std::string key, const std::string& a, const std::string& b) {
    std::replace(key.begin(), key.end(), '_', ' ');
    if (!text.empty()) text += "; ";
    text += fmt::format("{}: file {}, model {}", key, a, b);
  };
  for (const auto& [key, value] : model.items()) {
    if (!file.contains(key)) {
      add(key, "nothing", value.dump());
    } else if (file[key] != value) {
      add(key, file[key].dump(), value.dump());
    }
  }
  for (const auto& [key, value] : file.items()) {
    if (!model.contains(key)) add(key, value.dump(), "nothing");
  }
  return text;
}

}  // namespace gatelight::neural
