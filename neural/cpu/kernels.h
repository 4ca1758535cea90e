#pragma once
// The interface of the kernels: a table of functions for each instruction set, and the plain structs that
// they read. It is C-like, so that kernel_table.cpp can include it (see simd/vectors.h).
//
// Kernels process records in tiles of kTile. A tile's activations stay in the L1 and L2 caches, and kTile is
// a multiple of kBlockRows of every instruction set.

#include <stdint.h>

#include "neural/layout/gate_tables.h"

namespace gatelight::neural::cpu {

constexpr uint32_t kTile = 48;
constexpr uint32_t kMaxKernelLayers = 6;
constexpr uint32_t kMaxWidth = 128;
constexpr uint32_t kMaxKernelLevels = 16;
constexpr uint32_t kMaxAuxiliary = 16;
constexpr uint32_t kOutputStride = 16;  // floats per row of outputs and of their gradients

// The spans of QueryBatch; null if not used.
struct KernelPoints {
  const uint32_t* surfaces;
  const uint32_t* triangles;
  const float* barycentrics;
  const float* positions;
  const float* directions;
  const float* normals;
  const float* albedos;
  const float* roughnesses;
};

struct KernelHashLevel {
  float scale;
  uint32_t resolution, entries, first_node, dense;
  uint32_t multiplier, shift;  // for the division by entries / 8
};

enum class KernelEncoding : uint32_t { none, gate, hash_grid };
enum class KernelSource : uint32_t { position, direction, normal, albedo, roughness };
enum class KernelTransform : uint32_t { identity, one_blob, spherical_one_blob };

// Compute shaders read these words, too.
struct KernelAuxiliary {
  KernelSource source;
  KernelTransform transform;
  uint32_t coordinates, size, first_input, inputs;
};

// Maps points to nodes, and points and nodes to network inputs.
struct KernelEncoder {
  KernelEncoding encoding;
  uint32_t levels, nodes_per_level, features;  // `features` is L
  // GATE
  const GateSurface* surfaces;
  const GateSurfaceLevel* surface_levels;
  const uint32_t* topology;
  uint32_t surface_count;
  uint32_t per_triangle;
  // Hash grid and positions
  KernelHashLevel hash_levels[kMaxKernelLevels];
  float bounds_min[3];
  float inverse_extent;
  KernelAuxiliary auxiliary[kMaxAuxiliary];
  uint32_t auxiliary_count;
  // Feature vectors: halves if `half_features` is set, else floats. Node n starts at n * feature_stride.
  uint32_t feature_stride;
  const float* float_features;
  const uint16_t* half_features;
};

// Matrices are padded to 16 columns: `forward` is [inputs][padded outputs], `backward` is [outputs][padded
// inputs].
struct KernelLayer {
  uint32_t inputs, outputs;
  uint32_t padded_inputs, padded_outputs;
  float* forward;
  float* backward;         // in layer 0 for feature inputs only
  float* biases;           // padded; zeros without biases
  uint16_t* forward_bf16;  // [inputs / 2][padded outputs][2], with inputs padded to an even number
  float* forward_rounded;  // `forward` rounded to bf16, for instruction sets without bf16
  // For a last layer with up to four outputs, else null: [input / 16][input % 4][16]. Lane 4 g + o has the
  // weight of output o for input 4 g + (input % 4) of 16.
  float* forward_groups;
  float* forward_groups_rounded;
  // Offsets in the packed layout (packed_network.h): weights [inputs][padded outputs], in the last layer
  // [outputs][padded inputs]; biases [padded outputs].
  uint64_t gradient, bias_gradient;
};

struct KernelNetwork {
  KernelLayer layers[kMaxKernelLayers];
  uint32_t layer_count;
  uint32_t inputs, feature_inputs, input_stride;  // stride of a row of inputs: 16, 32, 64, 128 or 256
  uint32_t width, outputs;
  float slope;
};

// A reference of an accepted record to a node: gradient of the node += weight * feature_gradients[source
// ...].
struct KernelReference {
  uint32_t node;
  uint32_t source;
  float weight;
};

struct KernelChunkStatistics {
  double loss;  // sum over accepted records and outputs
  uint32_t accepted, rejected, unstored, clipped;
};

// Arguments of encode, forward, loss and backward for records [begin, end), which are whole chunks.
struct KernelTraining {
  const KernelEncoder* encoder;
  const KernelNetwork* network;
  KernelPoints points;
  const float* targets;
  uint32_t begin, end;
  uint32_t chunk_tiles;  // of a chunk; `begin` is that of a chunk
  uint32_t relative_loss;
  float max_target;
  float* scratch;            // KernelTable::scratch_floats floats, aligned to 64 bytes
  uint32_t* nodes;           // [tile][node slot][kTile]; weight 0 means no reference
  float* weights;            // as `nodes`
  float* feature_gradients;  // [record][feature_inputs]; gradients of the sum of the losses
  uint8_t* accepted;         // [record], or null
  // From the first chunk on: gradients of the network, gradient_size floats for each chunk, and statistics.
  float* gradients;
  uint64_t gradient_size;
  KernelChunkStatistics* statistics;
};

struct KernelQuery {
  const KernelEncoder* encoder;
  const KernelNetwork* network;
  KernelPoints points;
  uint64_t begin, end;
  uint32_t bf16;
  uint32_t range;  // 0 raw, 1 non-negative, 2 unit
  float* scratch;
  float* out;
};

// Adam's factors for a step count: p -= step m / (sqrt(v) + epsilon); average += average_rate (p - average).
struct KernelAdamStep {
  float step, epsilon, average_rate, unused;
};

struct KernelAdam {
  float beta1, beta2;
  float gradient_scale;
};

// Arguments for summing the references of one bucket of nodes, in their order, and updating the nodes.
struct KernelFeatureUpdate {
  const KernelReference* references;  // ordered by record
  uint32_t reference_count;
  uint32_t first_node, node_count;  // the bucket's nodes
  uint32_t features;
  uint32_t feature_inputs;
  const float* feature_gradients;
  const uint32_t* record_steps;  // per record, the triangle's step count (per_triangle); or null
  uint32_t dense;
  KernelAdam adam;
  const KernelAdamStep* steps;  // index t = 1 .. step_count
  uint32_t step_count;
  KernelAdamStep (*late_step)(const void* context, uint64_t t);  // for larger t
  const void* late_context;
  KernelAdamStep dense_step;
  // State. Node n's features and averages start at n * feature_stride, its moments (L floats m, L floats v)
  // at n * moment_stride, and its step count is at n * step_stride.
  uint32_t feature_stride, moment_stride, step_stride;
  float* features_fp32;     // parameters or masters; null in fp16 without masters
  uint16_t* features_fp16;  // null in fp32
  float* averages;          // null without averages
  uint16_t* averages_fp16;  // null unless averages are read in fp16
  float* moments;
  uint32_t* node_steps;  // null in dense mode
  // Scratch, all zero before and after: node_count x features sums and node_count / 64 + 1 words of touched
  // flags
  float* sums;
  uint64_t* touched;
  uint32_t* touched_list;  // node_count
  uint32_t* step_scratch;  // node_count, all zero before and after; used with record_steps only
  // Results
  uint64_t* touched_count;
  uint64_t* skipped_count;
};

struct KernelTable {
  /// Floats of scratch memory that train and query need.
  uint64_t (*scratch_floats)(const KernelEncoder&, const KernelNetwork&);
  void (*train)(const KernelTraining&);
  void (*query)(const KernelQuery&);
  void (*update_features)(const KernelFeatureUpdate&);
};

extern const KernelTable kScalarKernels;
extern const KernelTable kAvx2Kernels;
extern const KernelTable kAvx512Kernels;
extern const KernelTable kAvx512Bf16Kernels;

}  // namespace gatelight::neural::cpu
