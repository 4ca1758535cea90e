#pragma once
// What is learned: the configuration of encoding and network, and the one place that says where each
// parameter lies.

#include <cstdint>
#include <memory>
#include <vector>

#include "neural/layout/gate_layout.h"
#include "neural/layout/hash_grid.h"

namespace gatelight::neural {

enum class FeatureEncoding : std::uint8_t { none, gate, hash_grid };

enum class InputSource : std::uint8_t { position, direction, normal, albedo, roughness };

/// How a source becomes network inputs. `size` is the number of bins or of frequencies for each coordinate.
///   identity   the coordinates as they are (position: 3 in [0,1]; direction and normal: 3; albedo: 3;
///   roughness: 1) one_blob   `size` bins a coordinate, quartic kernel. Directions and normals in spherical
///   coordinates (theta/pi, then
///              phi/2pi, which wraps; theta does not); position and albedo: 3 coordinates in [0,1];
///              roughness: 1
///   frequency  sin and cos of 2^i pi x, i = 0 .. size-1: for each coordinate sin and cos in turn
enum class InputEncoding : std::uint8_t { identity, one_blob, frequency };

struct AuxiliaryInput {
  InputSource source = InputSource::direction;
  InputEncoding encoding = InputEncoding::one_blob;
  std::uint32_t size = 4;  ///< one_blob: 2 to 64 bins, a power of two; frequency: 1 to 16; identity: unused
};

/// Coordinates that the source has under this encoding, and the network inputs they become.
std::uint32_t coordinate_count(const AuxiliaryInput& input);
std::uint32_t input_count(const AuxiliaryInput& input);

/// What a scene's light depends on, beside the point on the surface.
struct RequiredInputs {
  bool direction = true;  ///< something in the scene is view-dependent
  bool normal = false;    ///< the paper: with the hash grid only
  bool albedo = false;    ///< the paper: with the hash grid only
  bool roughness = false;
};
/// Directions and normals one-blob with `bins` bins an axis, albedo and roughness as they are; only what is
/// required.
std::vector<AuxiliaryInput> composite_inputs(const RequiredInputs& required, std::uint32_t bins = 4);

struct MlpOptions {
  std::uint32_t width = 32;         ///< 16, 32, 64 or 128
  std::uint32_t hidden_layers = 2;  ///< 1 to 5
  std::uint32_t outputs = 3;        ///< 1 to 16
  float leaky_slope = 0.01f;        ///< of the hidden layers' leaky ReLU; the output is linear
  bool biases = true;
};

inline constexpr std::uint32_t kMaxInputs = 256;
inline constexpr std::uint32_t kMaxAuxiliaryInputs = 16;
inline constexpr std::uint32_t kMaxLayers = 6;

struct ModelConfig {
  FeatureEncoding encoding = FeatureEncoding::gate;
  GateOptions gate;
  HashGridOptions hash_grid;
  std::vector<AuxiliaryInput> auxiliary;  ///< follow the features, in this order; kMaxAuxiliaryInputs at most
  MlpOptions mlp;
};

/// Whether the encoding or an auxiliary input reads the source.
bool uses_input(const ModelConfig& config, InputSource source);

/// One layer: y = W x + b, W row-major [outputs][inputs] at `weights`, b at `biases` of the flat parameters.
struct LayerLayout {
  std::uint32_t inputs = 0;
  std::uint32_t outputs = 0;
  std::uint64_t weights = 0;
  std::uint64_t biases = 0;  ///< meaningless without biases
};

/// The flat parameters: features [node][L], then each layer's weights and biases. CPU, Vulkan, Adam's
/// moments, averages and the cache file all use these offsets.
struct ParameterLayout {
  std::uint32_t node_count = 0;
  std::uint32_t features = 0;        ///< L
  std::uint32_t feature_inputs = 0;  ///< network inputs from features: levels x L
  std::uint32_t inputs = 0;          ///< all network inputs
  std::uint64_t network = 0;         ///< offset of the first weight = node_count x L
  std::uint64_t count = 0;           ///< of all parameters
  bool biases = true;
  std::vector<LayerLayout> layers;

  std::uint64_t network_count() const { return count - network; }
};

/// A configuration with its resolved layouts. Immutable; shared by trainer, backends and files.
struct Model {
  ModelConfig config;
  GateLayout gate;           ///< empty unless encoding is gate
  HashGridLayout hash_grid;  ///< without levels unless encoding is hash_grid; maps position inputs too
  ParameterLayout parameters;
  /// Nodes that a point's encoding reads (3 a GATE level, 8 a hash level), their features' levels in a row.
  std::uint32_t nodes_per_point() const;
  std::uint32_t nodes_per_level() const;
  std::uint32_t levels() const;
};

/// `surfaces` is read only for gate. Throws BadConfiguration.
std::shared_ptr<const Model> make_model(const ModelConfig& config, const SurfaceLayout& surfaces = {});

}  // namespace gatelight::neural
