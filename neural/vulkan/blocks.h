#pragma once
// The data of a model and of a batch that shaders read, in std430 layout. Each field must match
// shaders/blocks.glsl. Address 0 means that the array does not exist.

#include <cstddef>
#include <cstdint>

#include "neural/layout/hash_grid.h"
#include "neural/model/model.h"

namespace gatelight::neural::vulkan {

using Address = std::uint64_t;

struct TableBlock {
  Address parts = 0;
  std::uint32_t shift = 0, stride = 0;
};

struct AuxiliaryBlock {
  std::uint32_t source = 0, transform = 0, coordinates = 0, size = 0, first_input = 0, inputs = 0;
};

struct AdamBlock {
  float beta1 = 0, beta2 = 0, learning_rate = 0, epsilon = 0, l2_network = 0, decay_steps = 0;
  float log_beta1 = 0, log_beta2 = 0, least_average_rate = 0, average_ramp = 0;
  std::uint32_t table_steps = 0, average_network = 0;
};

struct ModelBlock {
  TableBlock topology, features, halves, averages, average_halves, moments, node_steps, triangle_steps,
      triangle_stamps;
  Address surfaces = 0, levels = 0;
  Address parameters = 0, network_average = 0, first_moments = 0, second_moments = 0, forward = 0,
          backward = 0;
  Address adam_table = 0, progress = 0;
  std::uint32_t surface_count = 0, level_count = 0, nodes_per_level = 0, per_triangle = 0, node_count = 0;
  std::uint32_t feature_count = 0, feature_inputs = 0, inputs = 0, outputs = 0, width = 0, hidden_layers = 0,
                biases = 0, network_count = 0;
  std::uint32_t sources = 0, auxiliary_count = 0;
  float inverse_extent = 0, max_target = 0;
  float bounds_min[3] = {};
  HashGridLevel hash_levels[kMaxHashLevels];
  AuxiliaryBlock auxiliary[kMaxAuxiliaryInputs];
  AdamBlock adam;
};

struct BatchBlock {
  TableBlock read;
  Address surfaces = 0, triangles = 0, barycentrics = 0, positions = 0, directions = 0, normals = 0,
          albedos = 0, roughnesses = 0, targets = 0;
  Address inputs = 0, status = 0, record_triangles = 0, keys[2] = {}, values[2] = {}, weights = 0;
  Address feature_gradients = 0, losses = 0, partials = 0, counts = 0, piece_starts = 0, piece_sums = 0,
          piece_steps = 0, nodes = 0, node_pieces = 0, statistics = 0, answers = 0, forward = 0;
  std::uint32_t size = 0, capacity = 0, references = 0, tiles = 0, groups = 0, blocks = 0;
};

struct PushBlock {
  Address model = 0, batch = 0;
  std::uint32_t argument = 0, other = 0;
};

static_assert(sizeof(HashGridLevel) == 20 && sizeof(AuxiliaryBlock) == 24 && sizeof(AdamBlock) == 48);
static_assert(offsetof(ModelBlock, surfaces) == 144 && offsetof(ModelBlock, surface_count) == 224);
static_assert(offsetof(ModelBlock, bounds_min) == 292 && offsetof(ModelBlock, hash_levels) == 304);
static_assert(offsetof(ModelBlock, auxiliary) == 624 && offsetof(ModelBlock, adam) == 1008);
static_assert(offsetof(BatchBlock, size) == 248 && sizeof(BatchBlock) == 272);

/// Indices of the words of BatchBlock::statistics.
enum StatisticsWord : std::uint32_t {
  kAccepted,
  kRejected,
  kUnstored,
  kClipped,
  kSkipped,
  kPieces,
  kTouched,
  kLoss
};
inline constexpr std::uint32_t kStatisticsWords = 8;

/// Bits of pack_network's argument.
enum PackBits : std::uint32_t { kPackBackward = 1, kPackAveraged = 2, kPackRounded = 4 };

/// The bit of ModelBlock::sources for barycentrics; lower bits are those of InputSource.
inline constexpr std::uint32_t kBarycentricsSource = 5;

}  // namespace gatelight::neural::vulkan
