#include "neural/cpu/kernel_model.h"

#include <bit>

namespace gatelight::neural::cpu {

namespace {

static_assert(kMaxHashLevels == kMaxKernelLevels && kMaxLayers == kMaxKernelLayers &&
              kMaxAuxiliaryInputs == kMaxAuxiliary);

KernelHashLevel kernel_level(const HashGridLevel& level) {
  KernelHashLevel k{level.scale, level.resolution, level.entries, level.first_node, level.dense, 0, 0};
  const std::uint32_t divisor = level.entries / 8;
  k.shift = static_cast<std::uint32_t>(std::bit_width(divisor)) - 1;
  k.multiplier = static_cast<std::uint32_t>((std::uint64_t{1} << (32 + k.shift)) / divisor + 1);
  return k;
}

KernelTransform transform_of(const AuxiliaryInput& input) {
  const bool spherical = input.source == InputSource::direction || input.source == InputSource::normal;
  if (input.encoding == InputEncoding::identity) return KernelTransform::identity;
  return spherical ? KernelTransform::spherical_one_blob : KernelTransform::one_blob;
}

// Lookups on surfaces without storage read the first triangle's words, so these arrays stand in for empty
// tables.
constexpr std::uint32_t kNoTopology[6 + kTopologyPadding] = {};
constexpr GateSurface kNoSurface[1] = {};
constexpr GateSurfaceLevel kNoLevels[kMaxStack] = {};

}  // namespace

KernelEncoder kernel_encoder(const Model& model) {
  KernelEncoder e = {};
  e.encoding = static_cast<KernelEncoding>(model.config.encoding);
  e.levels = model.levels();
  e.nodes_per_level = model.nodes_per_level();
  e.features = model.parameters.features;
  const GateLayout& gate = model.gate;
  e.surfaces = gate.surfaces.empty() ? kNoSurface : gate.surfaces.data();
  e.surface_levels = gate.levels.empty() ? kNoLevels : gate.levels.data();
  e.topology = gate.topology.empty() ? kNoTopology : gate.topology.data();
  e.surface_count = static_cast<std::uint32_t>(gate.surfaces.size());
  e.per_triangle = gate.storage == NodeStorage::per_triangle ? 1 : 0;
  for (std::size_t l = 0; l < model.hash_grid.levels.size(); ++l)
    e.hash_levels[l] = kernel_level(model.hash_grid.levels[l]);
  for (int c = 0; c < 3; ++c) e.bounds_min[c] = model.hash_grid.bounds_min[static_cast<std::size_t>(c)];
  e.inverse_extent = model.hash_grid.inverse_extent;
  std::uint32_t first = model.parameters.feature_inputs;
  for (const AuxiliaryInput& input : model.config.auxiliary) {
    e.auxiliary[e.auxiliary_count++] = {static_cast<KernelSource>(input.source),
                                        transform_of(input),
                                        coordinate_count(input),
                                        input.size,
                                        first,
                                        input_count(input)};
    first += input_count(input);
  }
  return e;
}

KernelPoints kernel_points(const Model& model, const QueryBatch& batch) {
  const auto floats = [&](const auto& span, InputSource source) -> const float* {
    return uses_input(model.config, source) && !span.empty() ? span.data()->data() : nullptr;
  };
  KernelPoints p = {};
  if (model.config.encoding == FeatureEncoding::gate && batch.size > 0) {
    p.surfaces = batch.surfaces.data();
    p.triangles = batch.triangles.data();
    p.barycentrics = batch.barycentrics.data()->data();
  }
  p.positions = floats(batch.positions, InputSource::position);
  p.directions = floats(batch.directions, InputSource::direction);
  p.normals = floats(batch.normals, InputSource::normal);
  p.albedos = floats(batch.albedos, InputSource::albedo);
  p.roughnesses = uses_input(model.config, InputSource::roughness) ? batch.roughnesses.data() : nullptr;
  return p;
}

const KernelTable& kernel_table([[maybe_unused]] simd::Isa isa) {
#if defined(__x86_64__)
  switch (isa) {
    case simd::Isa::avx512:
      return __builtin_cpu_supports("avx512bf16") != 0 ? kAvx512Bf16Kernels : kAvx512Kernels;
    case simd::Isa::avx2:
      return kAvx2Kernels;
    case simd::Isa::scalar:
      break;
  }
#endif
  return kScalarKernels;
}

}  // namespace gatelight::neural::cpu
