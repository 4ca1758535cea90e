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
constexpr std::uint64_t kMaxSummingGroups = 2048;  // each adds its runs to one counter

bool is_dense(const StepPlan& plan) {
  return plan.options.update == FeatureUpdate::dense;
}

std::uint32_t per_triangle(const StepPlan& plan) {
  return plan.options.feature_step == FeatureStep::per_triangle && !is_dense(plan) ? 1u : 0u;
}

SortPlan sort_of(const StepPlan& plan) {
  return plan_sort(plan.model.parameters.node_count, plan.cut.references);
}

void record_network(const StepPlan& plan, Commands& commands) {
  const Model& model = plan.model;
  const std::uint32_t halves = plan.features.halves() ? 1u : 0u;
  if (plan.cut.references > 0) record_sort_clear(sort_of(plan), commands);
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
  if (plan.cut.references > 0) record_sort_start(sort_of(plan), commands);
  Constants constants = network_constants(model);
  constants.insert(constants.end(), {plan.tile, std::bit_cast<std::uint32_t>(model.config.mlp.leaky_slope),
                                     plan.options.loss == Loss::relative_l2 ? 1u : 0u});
  commands.dispatch(Shader::train_network, constants, plan.cut.groups);
  commands.barrier();
  commands.dispatch(Shader::count_step, {}, 1);  // beside the first part of the sort
  if (plan.cut.references == 0) commands.barrier();
}

void record_gradients(const StepPlan& plan, Commands& commands) {
  const SortPlan sort = sort_of(plan);
  record_sort_rest(sort, commands);
  commands.dispatch(Shader::sum_pieces, Constants{plan.model.parameters.features, per_triangle(plan)},
                    std::min(groups_for(plan.cut.references), kMaxSummingGroups), sort.result());
  commands.barrier();
}

void record_updates(const StepPlan& plan, Commands& commands) {
  const Model& model = plan.model;
  const std::uint64_t parameters = model.parameters.network_count();
  commands.dispatch(Shader::update_network, {}, (parameters + kParametersAGroup - 1) / kParametersAGroup);
  if (plan.cut.references > 0) {
    const std::uint64_t items = is_dense(plan) ? model.parameters.node_count : plan.cut.references;
    const FeatureStore& features = plan.features;
    commands.dispatch(
        Shader::update_nodes,
        Constants{model.parameters.features, per_triangle(plan), is_dense(plan) ? 1u : 0u,
                  features.floats() ? 1u : 0u, features.halves() ? 1u : 0u, features.averages() ? 1u : 0u},
        std::min(groups_for(items), kMaxLoopingGroups), sort_of(plan).result());
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
