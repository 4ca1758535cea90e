#include "neural/vulkan/step_commands.h"

#include <algorithm>
#include <bit>

#include "neural/vulkan/network_store.h"
#include "neural/vulkan/sort_commands.h"

namespace gatelight::neural::vulkan {

namespace {

using Constants = std::vector<std::uint32_t>;

constexpr std::uint32_t kParametersAGroup = 8;  // of update_network
/// Of shaders whose threads take any number of items: more than an H100 runs at a time (2112). Further ones
/// would mostly find none, as their number is an upper limit.
constexpr std::uint64_t kMaxLoopingGroups = 4096;

bool is_dense(const StepPlan& plan) {
  return plan.options.update == FeatureUpdate::dense;
}

std::uint32_t per_triangle(const StepPlan& plan) {
  return plan.options.feature_step == FeatureStep::per_triangle && !is_dense(plan) ? 1u : 0u;
}

void record_network(const StepPlan& plan, Commands& commands) {
  const Model& model = plan.model;
  const std::uint32_t halves = plan.features.halves() ? 1u : 0u;
  commands.dispatch(Shader::encode,
                    Constants{static_cast<std::uint32_t>(model.config.encoding), halves,
                              std::max(model.parameters.features, 1u)},
                    groups_for(plan.cut.size));
  commands.barrier();
  if (plan.may_be_first && plan.options.start_at_mean && model.parameters.biases) {
    const std::uint64_t bias = model.parameters.layers.back().biases - model.parameters.network;
    commands.dispatch(Shader::start_mean, {}, 1, static_cast<std::uint32_t>(bias));
    commands.barrier();
  }
  if (plan.features.counts_triangles())
    commands.dispatch(Shader::count_triangles, {}, groups_for(plan.cut.size));
  Constants constants = network_constants(model);
  constants.insert(constants.end(), {plan.tile, std::bit_cast<std::uint32_t>(model.config.mlp.leaky_slope),
                                     plan.options.loss == Loss::relative_l2 ? 1u : 0u});
  commands.dispatch(Shader::train_network, constants, plan.cut.groups);
  commands.barrier();
  commands.dispatch(Shader::count_step, {}, 1);  // beside the first part of the sort
  if (plan.cut.references == 0) commands.barrier();
}

void record_gradients(const StepPlan& plan, Commands& commands) {
  const std::uint32_t sorted = record_sort(plan.model.parameters.node_count, plan.cut.blocks, commands);
  record_runs(sorted, plan.cut.blocks, commands);
  const std::uint32_t features = plan.model.parameters.features;
  const std::uint64_t threads = std::uint64_t{plan.cut.references} * features;
  commands.dispatch(Shader::sum_pieces, Constants{features, per_triangle(plan)},
                    std::min(groups_for(threads), kMaxLoopingGroups), sorted);
  commands.barrier();
}

void record_updates(const StepPlan& plan, Commands& commands) {
  const Model& model = plan.model;
  const std::uint64_t parameters = model.parameters.network_count();
  commands.dispatch(Shader::update_network, {}, (parameters + kParametersAGroup - 1) / kParametersAGroup);
  if (plan.cut.references > 0) {
    const std::uint64_t nodes = is_dense(plan) ? model.parameters.node_count
                                               : std::min(plan.cut.references, model.parameters.node_count);
    const FeatureStore& features = plan.features;
    commands.dispatch(
        Shader::update_nodes,
        Constants{model.parameters.features, per_triangle(plan), is_dense(plan) ? 1u : 0u,
                  features.floats() ? 1u : 0u, features.halves() ? 1u : 0u, features.averages() ? 1u : 0u},
        std::min(groups_for(nodes), kMaxLoopingGroups));
  }
  commands.barrier();
}

}  // namespace

void record_training_pack(const Model& model, Commands& commands) {
  commands.dispatch(Shader::pack_network, {}, groups_for(model.parameters.network_count()),
                    glsl::kPackBackward);
}

void record_step(const StepPlan& plan, const vk::raii::QueryPool& stamps, std::uint32_t start,
                 Commands& commands) {
  record_network(plan, commands);
  commands.stamp(stamps, start + 1);
  if (plan.cut.references > 0) record_gradients(plan, commands);
  commands.stamp(stamps, start + 2);
  record_updates(plan, commands);
  commands.stamp(stamps, start + 3);
}

}  // namespace gatelight::neural::vulkan
