#pragma once
// A surface of one million triangles, models on it and points to train and ask: what train_step, query and
// mlp measure. No scene is needed, and no ray.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "neural/model/backend.h"

namespace gatelight::bench {

/// A torus with bumps of kColumns x kRows quads, closed, its vertices welded.
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

/// What the point on the surface becomes. Hash grids are the paper's 8 levels x 4 features at base 2, with
/// normal and albedo as further inputs of nrc; they differ in bytes.
enum class Encoding : std::uint8_t {
  gate,         ///< two levels, R = 2 and 1
  hash_grid,    ///< as many bytes as gate
  hash_grid_m,  ///< 132.24 MB for nrc, 83.09 MB for nao: the paper's M
  hash_grid_s,  ///< 0.91 MB: the paper's S
};

struct NeuralCase {
  Cache cache = Cache::nrc;
  Encoding encoding = Encoding::gate;
  friend bool operator==(const NeuralCase&, const NeuralCase&) = default;
};
/// "nrc/gate"
std::string case_name(const NeuralCase& which);

neural::ModelConfig neural_config(const NeuralCase& which);
/// Built when it is first asked for, then kept. Not thread-safe.
std::shared_ptr<const neural::Model> neural_model(const NeuralCase& which);

/// Points with everything that any of the models reads.
struct NeuralPoints {
  std::vector<std::uint32_t> surfaces, triangles;
  std::vector<neural::Float2> barycentrics;
  std::vector<neural::Float3> positions, directions, normals, albedos;
  std::vector<float> targets;  ///< 3 a point

  std::size_t size() const { return triangles.size(); }
  neural::QueryBatch query_batch() const;
};

enum class Order : std::uint8_t {
  coherent,  ///< pixels in rows over neighbouring triangles, two of them to a triangle
  random,    ///< any triangle of the surface
  sorted,    ///< likewise, in the order of their numbers
};
std::string order_name(Order order);

/// Pixels are two a quad in each direction, and begin at a place of the surface that `patch` decides. Random
/// points are as many.
NeuralPoints make_points(Order order, std::uint32_t width, std::uint32_t height, std::uint32_t patch);

inline constexpr std::uint32_t kBatchWidth = 256;
inline constexpr std::uint32_t kBatchHeight = 192;
inline constexpr std::uint32_t kBatchRecords = kBatchWidth * kBatchHeight;  ///< 49152

/// Batches of 49152 records at different places, so that a step finds none of the last one's nodes in a cache
/// that a renderer would have emptied.
const std::vector<NeuralPoints>& training_points(Order order);
/// The first `outputs` of the three.
std::vector<float> training_targets(const NeuralPoints& points, std::uint32_t outputs);
/// 1920x1080.
const NeuralPoints& query_points(Order order);

/// Floating-point operations of the network that a record needs, without encoding, biases, activations or
/// loss: two for each weight forward, for each weight's gradient, and for each gradient of an input that is a
/// feature or a neuron.
double forward_operations(const neural::ParameterLayout& layout);
double training_operations(const neural::ParameterLayout& layout);

}  // namespace gatelight::bench
