#pragma once
// How the cache learns and answers. Plain data with defaults; the command line binds its flags to these
// members.

#include <cstdint>
#include <optional>
#include <string>

#include "neural/model/model.h"
#include "neural/model/training_options.h"

namespace gatelight::renderer {

/// The part of the light reflected at a point that the cache stands for. The rest is sampled where the cache
/// is asked. cache/held_light.h is the one definition; targets, ends of paths and pictures follow it.
enum class CacheHolds : std::uint8_t {
  all,       ///< everything (the paper)
  no_delta,  ///< all but what arrives straight from punctual lights: one shadow ray more, and sharp sun edges
  indirect,  ///< only light that has been scattered once more: next-event estimation at the point
};

/// Where a camera path asks the cache for its rest.
enum class QueryAt : std::uint8_t {
  primary,  ///< the first vertex (the paper)
  gather,   ///< the vertex after the first wide scattering event
  spread,   ///< where the path has spread out (Mueller et al. 2021)
  none,     ///< nowhere: paths run to their end. What the cache should have answered
};

enum class CacheView : std::uint8_t {
  final,  ///< the picture
  cache,  ///< the paper's picture: the answer at the first vertex, without emission, reflectance and what the
          ///< cache does not hold
};

enum class TrainingSource : std::uint8_t {
  camera,   ///< what the camera sees: stratified over the picture
  surface,  ///< uniform by area over all surfaces with storage
};

/// Training paths that end in the cache's own answer (Mueller et al. 2021).
struct SelfTrainingOptions {
  int start_step = 192;           ///< paths run to their end before it; negative: always
  int vertices = 2;               ///< with a record, before the answer
  float full_fraction = 0.0625f;  ///< of the paths that run to their end all the same
  float attenuation = 1.0f;       ///< factor of the answer, in [0, 1]
};

struct CacheOptions {
  // When and from what it learns.
  std::optional<int> train_steps;  ///< none: chosen from the picture's pixels and samples
  double train_seconds = 0.0;      ///< no further steps after this time; 0: none
  std::uint32_t batch = 4096;      ///< records of a step
  int path_length = 0;             ///< scattering events of a training path; 0: by Russian roulette alone
  int samples_per_point = 1;       ///< paths averaged in the record of a training point
  TrainingSource source = TrainingSource::camera;
  int candidates = 1;  ///< of which a training point is chosen by how seldom its triangle was trained
  SelfTrainingOptions self_training;
  /// Node spacing in metres; none: chosen from the size of what the scouting paths met. Overrides
  /// gate.node_spacing.
  std::optional<float> node_spacing;

  // What it is. The input encodings and the hash grid's bounds follow from the scene.
  neural::FeatureEncoding encoding = neural::FeatureEncoding::gate;
  /// Each level three times as coarse as the one before, also where triangles are small and their vertices
  /// clustered: what few records a preview has teach the coarse ones first.
  neural::GateOptions gate = {.stack = {neural::kAdaptive, neural::adaptive_part(3), neural::adaptive_part(9),
                                        neural::adaptive_part(27)}};
  neural::HashGridOptions hash_grid;
  std::uint64_t memory_bytes = 0;  ///< of all features, for either encoding; 0: none
  neural::MlpOptions mlp;
  neural::TrainingOptions training = {.adam = {.learning_rate = 1e-2f}};
  /// Inputs beside the position. None: those that the scene and the encoding need.
  std::optional<bool> direction_input, normal_input, albedo_input;
  bool scout = true;  ///< storage only for the sides of instances that scouting paths meet

  // What it is asked.
  CacheHolds holds = CacheHolds::no_delta;
  QueryAt query_at = QueryAt::gather;
  CacheView view = CacheView::final;
  /// Lobes at least this rough (perceptual, as in glTF) belong to the cache; narrower ones are traced on from
  /// the vertex where it is asked. 0: only deltas are.
  float min_roughness = 0.5f;
  float spread_threshold = 0.01f;  ///< c of the area-spread rule
  bool bf16_queries = false;

  // Files and machine.
  std::string device = "cpu";
  std::string cache_in;
  std::string cache_out;
};

}  // namespace gatelight::renderer
