#include "apps/reports/cache_recipe.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/settings/cache_choices.h"
#include "apps/terminal/text.h"
#include "renderer/settings/option_words.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using renderer::CacheOptions;

void add_learning(ordered_json& json, const CacheOptions& o) {
  json["train-steps"] = o.train_steps ? ordered_json(*o.train_steps) : ordered_json("auto");
  json["train-time"] = o.train_seconds;
  json["batch"] = o.batch;
  json["train-path-length"] = o.path_length;
  json["samples-per-point"] = o.samples_per_point;
  json["training-points"] = name_of(training_source_choices(), o.source);
  json["candidates"] = o.candidates;
  const bool trains_itself = o.self_training.start_step >= 0;
  json["self-training"] = trains_itself ? ordered_json(o.self_training.start_step) : ordered_json("off");
  json["self-training-vertices"] = o.self_training.vertices;
  json["self-training-full"] = shortest(o.self_training.full_fraction);
  json["self-training-attenuation"] = shortest(o.self_training.attenuation);
  json["learning-rate"] = shortest(o.training.adam.learning_rate);
  json["learning-decay"] = shortest(o.training.adam.decay_steps);
  json["loss"] = name_of(loss_choices(), o.training.loss);
  json["update"] = name_of(update_choices(), o.training.update);
  json["average"] = name_of(on_off_choices(), o.training.average.network);
}

void add_encoding(ordered_json& json, const CacheOptions& o) {
  json["encoding"] = name_of(encoding_choices(), o.encoding);
  json["hash-levels"] = o.hash_grid.levels;
  json["hash-features"] = o.hash_grid.features;
  json["hash-log2-size"] = o.hash_grid.log2_table_size;
  json["hash-base"] = o.hash_grid.base_resolution;
  json["hash-growth"] = shortest(o.hash_grid.growth);
  const neural::GateOptions& gate = o.gate;
  json["features"] = gate.features;
  json["stack"] = renderer::stack_text(gate.stack);
  json["resolution"] = resolution_text(gate);
  json["resolution-scale"] = shortest(gate.resolution_scale);
  json["node-spacing"] = o.node_spacing ? ordered_json(shortest(*o.node_spacing)) : ordered_json("auto");
  json["max-resolution"] = gate.max_resolution;
  json["cluster"] = name_of(auto_off_choices(), gate.cluster);
  json["storage"] = name_of(storage_choices(), gate.storage);
  json["feature-step"] = name_of(feature_step_choices(), o.training.feature_step);
}

void add_shape(ordered_json& json, const CacheOptions& o) {
  add_encoding(json, o);
  json["cache-memory"] = static_cast<double>(o.memory_bytes) / 1048576.0;
  json["feature-precision"] = name_of(feature_precision_choices(), o.training.precision);
  json["hidden"] = o.mlp.width;
  json["layers"] = o.mlp.hidden_layers;
  json["bias"] = name_of(on_off_choices(), o.mlp.biases);
  json["direction-input"] = name_of(input_choices(), o.direction_input);
  json["normal-input"] = name_of(input_choices(), o.normal_input);
  json["albedo-input"] = name_of(input_choices(), o.albedo_input);
  json["scout"] = name_of(on_off_choices(), o.scout);
}

void add_answers(ordered_json& json, const CacheOptions& o) {
  json["cache-holds"] = name_of(cache_holds_choices(), o.holds);
  json["query-at"] = name_of(query_at_choices(), o.query_at);
  json["view"] = name_of(cache_view_choices(), o.view);
  json["cache-roughness"] = shortest(o.min_roughness);
  json["spread-threshold"] = shortest(o.spread_threshold);
  json["query-precision"] = name_of(query_precision_choices(), o.bf16_queries);
  json["device"] = o.device;
}

}  // namespace

ordered_json resolved_cache_options(const RenderSettings& settings) {
  const CacheOptions& options = settings.render.cache;
  ordered_json json;
  if (settings.preset && !settings.reproducible) json["preset"] = name_of(preset_choices(), *settings.preset);
  add_learning(json, options);
  add_shape(json, options);
  add_answers(json, options);
  for (const std::string& flag : cache_flags_without_effect(settings.render)) json.erase(flag.substr(2));
  if (!options.cache_in.empty()) json["cache-in"] = options.cache_in;
  if (!options.cache_out.empty() && !settings.reproducible) json["cache-out"] = options.cache_out;
  return json;
}

}  // namespace gatelight::apps
