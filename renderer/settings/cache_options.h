#pragma once
// Training of the cache, and its queries.

#include <cstdint>
#include <optional>
#include <string>

#include "neural/model/model.h"
#include "neural/model/training_options.h"

namespace gatelight::renderer {

/// The part of the light reflected at a point that the cache stores. The rest is sampled where the cache is
/// queried. cache/cached_light.h is the definition.
enum class CachedComponent : std::uint8_t {
  all,       ///< everything (the paper)
  no_delta,  ///< all except direct light of punctual lights, which costs one shadow ray and has sharp edges
  indirect,  ///< only indirect light; direct light is sampled at the point
};

/// Where a camera path queries the cache and ends.
enum class QueryAt : std::uint8_t {
  primary,  ///< the first vertex (the paper)
  gather,   ///< the vertex after the first wide scattering event
  spread,   ///< where the path has spread out (Mueller et al. 2021)
  none,     ///< nowhere: paths are traced to their end, as a reference for the cache
};

enum class CacheOutput : std::uint8_t {
  final,  ///< the picture
  cache,  ///< the paper's picture: only the answer at the first vertex, without emission, reflectance and
          ///< light that the cache does not store
};

enum class TrainingSource : std::uint8_t {
  picture,  ///< the picture's own samples, which stay in it
  camera,   ///< hits of camera rays, stratified over the picture
  surface,  ///< uniform by area over all surfaces with storage
};

/// Training paths that end in the cache's own answer (Mueller et al. 2021).
struct SelfTrainingOptions {
  int start_step = 192;           ///< before it, paths are traced to their end; negative: always
  int vertices = 2;               ///< vertices that become records before the answer
  float full_fraction = 0.0625f;  ///< share of the paths that are still traced to their end
  float attenuation = 1.0f;       ///< factor of the answer, in [0, 1]
};

struct CacheOptions {
  // Training.
  std::optional<int> train_steps;  ///< empty: chosen from the picture's pixels and samples
  double train_seconds = 0.0;      ///< no further steps after this time; 0: no limit
  std::uint32_t batch = 4096;      ///< records of a step
  int path_length = 0;             ///< scattering events of a training path; 0: only Russian roulette
  int samples_per_point = 1;       ///< paths averaged in the record of a training point
  TrainingSource source = TrainingSource::camera;
  int samples_from_step = 32;  ///< first step whose paths are samples; earlier, the cache is too coarse
  int candidates = 1;          ///< points from which the one with the least trained triangle is chosen
  SelfTrainingOptions self_training;
  /// Node spacing in metres; empty: chosen by scouting. Overrides gate.node_spacing.
  std::optional<float> node_spacing;

  // The model. Input encodings and the hash grid's bounds follow from the scene.
  neural::FeatureEncoding encoding = neural::FeatureEncoding::gate;
  /// Each level is three times coarser than the previous one, even where vertices of small triangles are
  /// clustered, because the few records of a preview train the coarse levels first.
  neural::GateOptions gate = {.stack = {neural::kAdaptive, neural::adaptive_part(3), neural::adaptive_part(9),
                                        neural::adaptive_part(27)}};
  neural::HashGridOptions hash_grid;
  std::uint64_t memory_bytes = 0;  ///< of all features, for either encoding; 0: no limit
  neural::MlpOptions mlp;
  neural::TrainingOptions training = {.adam = {.learning_rate = 1e-2f}};
  /// Inputs besides the position. Empty: chosen from scene and encoding.
  std::optional<bool> direction_input, normal_input, albedo_input;
  bool scout = true;  ///< store features only for the sides of instances that scouting paths hit

  // Queries.
  CachedComponent component = CachedComponent::no_delta;
  QueryAt query_at = QueryAt::gather;
  CacheOutput view = CacheOutput::final;
  /// The cache answers lobes at least this rough (perceptual, as in glTF); narrower ones are traced further.
  /// 0: only delta lobes are traced.
  float min_roughness = 0.5f;
  float spread_threshold = 0.01f;  ///< c of the area-spread rule
  bool bf16_queries = false;

  // Files and machine.
  std::string device = "cpu";
  /// Take a graphics device instead of the CPU if a trial is faster there (cache/device_trial.h). Not with
  /// files or processes that have to agree: checkpoints, loaded caches, ranks.
  bool choose_device = false;
  std::string cache_in;
  std::string cache_out;
};

/// Adds the name and value of each member that affects bits, as add_plain_members() of RenderOptions does.
/// The time limit of training and the output file affect none; a device is only chosen where it need not be
/// known before.
template <class Texts>
void add_plain_members(Texts& texts, const CacheOptions& options) {
  [[maybe_unused]] const auto& [train_steps, train_seconds, batch, path_length, samples_per_point, source,
                                samples_from_step, candidates, self_training, node_spacing, encoding, gate,
                                hash_grid, memory_bytes, mlp, training, direction_input, normal_input,
                                albedo_input, scout, component, query_at, view, min_roughness,
                                spread_threshold, bf16_queries, device, choose_device, cache_in, cache_out] =
      options;
  const auto& [start_step, vertices, full_fraction, attenuation] = self_training;
  const auto& [width, hidden_layers, outputs, leaky_slope, biases] = mlp;
  texts.add("train-steps", train_steps, "auto");
  texts.add("batch", batch);
  texts.add("train-path-length", path_length);
  texts.add("samples-per-point", samples_per_point);
  texts.add("training-points", source);
  texts.add("samples-from-step", samples_from_step);
  texts.add("candidates", candidates);
  texts.add("self-training", start_step);
  texts.add("self-training-vertices", vertices);
  texts.add("self-training-full", full_fraction);
  texts.add("self-training-attenuation", attenuation);
  texts.add("node-spacing", node_spacing, "auto");
  texts.add("encoding", encoding);
  if (encoding == neural::FeatureEncoding::gate) texts.add(gate);
  if (encoding == neural::FeatureEncoding::hash_grid) texts.add(hash_grid);
  texts.add("cache-memory", memory_bytes);
  texts.add("hidden", width);
  texts.add("layers", hidden_layers);
  texts.add("outputs", outputs);
  texts.add("leaky-slope", leaky_slope);
  texts.add("bias", biases);
  texts.add(training);
  texts.add("direction-input", direction_input, "auto");
  texts.add("normal-input", normal_input, "auto");
  texts.add("albedo-input", albedo_input, "auto");
  texts.add("scout", scout);
  texts.add("cache-holds", component);
  texts.add("query-at", query_at);
  texts.add("view", view);
  texts.add("cache-roughness", min_roughness);
  texts.add("spread-threshold", spread_threshold);
  texts.add("query-precision", bf16_queries);
  texts.add("device", device);
  texts.add("cache-in", cache_in.empty() ? "none" : cache_in);
}

}  // namespace gatelight::renderer
