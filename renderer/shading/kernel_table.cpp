// The kernels of wide shading, compiled once for each instruction set. GATELIGHT_KERNEL_TABLE is the name of
// the table.

#include "renderer/shading/kernel_scatter.h"
#include "renderer/shading/kernel_tables.h"

namespace gatelight::renderer {
namespace {

void sample_lights(ShadingBlock& block, const ShadingContext& context) {
  for (int at = 0; at < block.count; at += kLanes) sample_lights_at(block, context, at);
}
void scatter(ShadingBlock& block, const ShadingContext& context) {
  for (int at = 0; at < block.count; at += kLanes) scatter_at(block, context, at);
}
void albedo(ShadingBlock& block, const ShadingContext& context) {
  for (int at = 0; at < block.count; at += kLanes) albedo_at(block, context, at);
}
void light(ShadingBlock& block, const ShadingContext& context) {
  for (int at = 0; at < block.count; at += kLanes)
    evaluate_light(block, context, LaneBsdf(block, context, at), at);
}

}  // namespace

const ShadingKernels GATELIGHT_KERNEL_TABLE = {sample_lights, scatter, albedo, light};

}  // namespace gatelight::renderer
