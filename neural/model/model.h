#pragma once
// The model: the configuration of encoding and network, and the offset of each parameter.

#include <cstdint>
#include <memory>
#include <vector>

#include "neural/layout/gate_layout.h"
#include "neural/layout/hash_grid.h"

namespace gatelight::neural {

enum class FeatureEncoding : std::uint8_t { none, gate, hash_grid };

enum class InputSource : std::uint8_t { position, direction, normal, albedo, roughness };

/// The encoding of a source as network inputs.
/// - identity: the coordinates themselves. A position has 3 in [0,1], direction, normal and albedo have 3,
///   roughness has 1.
/// - one_blob: `size` bins per coordinate, with a quartic kernel. Directions and normals use the spherical
///   coordinates theta/pi and phi/2pi; only the second wraps. Positions and albedo have 3 coordinates in
///   [0,1], roughness has 1.
enum class InputEncoding : std::uint8_t { identity, one_blob };

struct AuxiliaryInput {
  InputSource source = InputSource::direction;
  InputEncoding encoding = InputEncoding::one_blob;
  std::uint32_t size = 4;  ///< one_blob: 2 to 64 bins, a power of two; identity: unused
};

/// Number of coordinates of the source with this encoding, and number of network inputs that they become.
std::uint32_t coordinate_count(const AuxiliaryInput& input);
std::uint32_t input_count(const AuxiliaryInput& input);

/// The inputs that a scene's radiance needs besides the point on the surface.
struct RequiredInputs {
  bool direction = true;  ///< some material of the scene is view-dependent
  bool normal = false;    ///< the paper uses it with the hash grid only
  bool albedo = false;    ///< the paper uses it with the hash grid only
  bool roughness = false;
};
/// The auxiliary inputs for `required`: directions and normals as one-blob with `bins` bins per coordinate,
/// albedo and roughness as identity.
std::vector<AuxiliaryInput> composite_inputs(const RequiredInputs& required, std::uint32_t bins = 4);

struct MlpOptions {
  std::uint32_t width = 32;         ///< 16, 32, 64 or 128
  std::uint32_t hidden_layers = 2;  ///< 1 to 5
  std::uint32_t outputs = 3;        ///< 1 to 16
  float leaky_slope = 0.01f;        ///< slope of the hidden layers' leaky ReLU; the output is linear
  bool biases = true;
};

inline constexpr std::uint32_t kMaxInputs = 256;
inline constexpr std::uint32_t kMaxAuxiliaryInputs = 16;
inline constexpr std::uint32_t kMaxLayers = 6;

struct ModelConfig {
  FeatureEncoding encoding = FeatureEncoding::gate;
  GateOptions gate;
  HashGridOptions hash_grid;
  std::vector<AuxiliaryInput> auxiliary;  ///< inputs after the features; at most kMaxAuxiliaryInputs
  MlpOptions mlp;
};

/// Whether the encoding or an auxiliary input reads the source.
bool uses_input(const ModelConfig& config, InputSource source);

/// One layer: y = W x + b, W row-major [outputs][inputs] at `weights`, b at `biases` of the flat parameters.
struct LayerLayout {
  std::uint32_t inputs = 0;
  std::uint32_t outputs = 0;
  std::uint64_t weights = 0;
  std::uint64_t biases = 0;  ///< unused without biases
};

/// The flat parameters: features [node][L], then each layer's weights and biases. CPU, Vulkan, Adam's
/// moments, averages and the cache file all use these offsets.
struct ParameterLayout {
  std::uint32_t node_count = 0;
  std::uint32_t features = 0;        ///< L
  std::uint32_t feature_inputs = 0;  ///< network inputs from features: levels x L
  std::uint32_t inputs = 0;          ///< all network inputs
  std::uint64_t network = 0;         ///< offset of the first weight = node_count x L
  std::uint64_t count = 0;           ///< number of all parameters
  bool biases = true;
  std::vector<LayerLayout> layers;

  std::uint64_t network_count() const { return count - network; }
};

/// A configuration with its layouts. It is immutable; trainer, backends and files share it.
struct Model {
  ModelConfig config;
  GateLayout gate;           ///< empty unless encoding is gate
  HashGridLayout hash_grid;  ///< without levels unless encoding is hash_grid; also maps position inputs
  ParameterLayout parameters;
  /// Number of nodes that a point's encoding reads: 3 per GATE level, 8 per hash-grid level.
  std::uint32_t nodes_per_point() const;
  std::uint32_t nodes_per_level() const;
  std::uint32_t levels() const;
};

/// Makes a model; only `gate` reads `surfaces`. Throws BadConfiguration.
std::shared_ptr<const Model> make_model(const ModelConfig& config, const SurfaceLayout& surfaces = {});

}  // namespace gatelight::neural
