#pragma once
// A surface of one million triangles, models on it, and points for training and queries. train_step and
// query measure on it, without a scene and without rays.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "neural/model/backend.h"

namespace gatelight::bench {

/// A closed torus with bumps, of kColumns x kRows quads with welded vertices.
struct NeuralSurface {
  static constexpr std::uint32_t kColumns = 1000;
  static constexpr std::uint32_t kRows = 500;
  std::vector<neural::Float3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  neural::Float3 bounds_min{}, bounds_max{};
};
const NeuralSurface& neural_surface();

enum class Cache : std::uint8_t {
  nrc,  ///< radiance: L = 8, 16 direction inputs, 2 x 32, 3 outputs
  nao,  ///< ambient occlusion: L = 2, no direction, 2 x 32, 1 output
};

/// The encoding of a point on the surface. The hash grid has the paper's 8 levels x 4 features at base 2. Its
/// nrc has normal and albedo as additional inputs.
enum class Encoding : std::uint8_t {
  gate,       ///< two levels, R = 2 and 1
  hash_grid,  ///< of the same size as gate
};

struct NeuralCase {
  Cache cache = Cache::nrc;
  Encoding encoding = Encoding::gate;
  friend bool operator==(const NeuralCase&, const NeuralCase&) = default;
};
/// "nrc/gate"
std::string case_name(const NeuralCase& which);

neural::ModelConfig neural_config(const NeuralCase& which);
/// Built at the first call, then kept. Not thread-safe.
std::shared_ptr<const neural::Model> neural_model(const NeuralCase& which);

/// Points with all inputs that any of the models reads, and random targets.
struct NeuralPoints {
  std::vector<std::uint32_t> surfaces, triangles;
  std::vector<neural::Float2> barycentrics;
  std::vector<neural::Float3> positions, directions, normals, albedos;
  std::vector<float> targets;  ///< 3 per point

  std::size_t size() const { return triangles.size(); }
  neural::QueryBatch query_batch() const;
};

enum class Order : std::uint8_t {
  coherent,  ///< pixels in rows over neighbouring triangles, two pixels per triangle
  random,    ///< any triangle of the surface
  sorted,    ///< any triangle, in the order of the triangles' numbers
};
std::string order_name(Order order);

/// A quad has two pixels in each direction. The pixels begin at a place of the surface that depends on
/// `patch`. Random points have the same number.
NeuralPoints make_points(Order order, std::uint32_t width, std::uint32_t height, std::uint32_t patch);

inline constexpr std::uint32_t kBatchWidth = 256;
inline constexpr std::uint32_t kBatchHeight = 192;
inline constexpr std::uint32_t kBatchRecords = kBatchWidth * kBatchHeight;  ///< 49152

/// Batches of 49152 records at different places. So a step does not find the nodes of the last step in the
/// processor's cache, as in a renderer.
const std::vector<NeuralPoints>& training_points(Order order);
/// The first `outputs` of the three targets of each point.
std::vector<float> training_targets(const NeuralPoints& points, std::uint32_t outputs);
/// 1920x1080 points.
const NeuralPoints& query_points(Order order);

}  // namespace gatelight::bench
