#include "neural/model/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "base/require.h"

namespace gatelight::neural {

namespace {

void check_size(const char* what, std::uint64_t size, std::uint64_t expected) {
  if (size != expected) throw BadConfiguration(fmt::format("{}: {}, expected {}", what, size, expected));
}

void check_numbers(const char* what, const std::vector<float>& values, float least, const char* expected) {
  const auto bad =
      std::find_if(values.begin(), values.end(), [&](float x) { return !(std::isfinite(x) && x >= least); });
  if (bad != values.end())
    throw BadConfiguration(
        fmt::format("{}, number {}: {}, expected {}", what, bad - values.begin(), *bad, expected));
}

}  // namespace

void check_batch(const Model& model, const QueryBatch& batch) {
  const auto check = [&](const char* what, const auto& span, bool required) {
    if (required || !span.empty()) check_size(what, span.size(), batch.size);
  };
  const auto uses = [&](InputSource source) { return uses_input(model.config, source); };
  const bool gate = model.config.encoding == FeatureEncoding::gate;
  check("surfaces of the batch", batch.surfaces, gate);
  check("triangles of the batch", batch.triangles, gate);
  check("barycentrics of the batch", batch.barycentrics, gate);
  check("positions of the batch", batch.positions, uses(InputSource::position));
  check("directions of the batch", batch.directions, uses(InputSource::direction));
  check("normals of the batch", batch.normals, uses(InputSource::normal));
  check("albedos of the batch", batch.albedos, uses(InputSource::albedo));
  check("roughnesses of the batch", batch.roughnesses, uses(InputSource::roughness));
}

void check_batch(const Model& model, const TrainingBatch& batch) {
  check_batch(model, batch.points);
  check_size("targets of the batch", batch.targets.size(), batch.points.size * model.config.mlp.outputs);
}

void check_batch(const Model& model, const QueryBatch& batch, std::span<const float> out) {
  check_batch(model, batch);
  check_size("floats for the answers", out.size(), batch.size * model.config.mlp.outputs);
}

void check_options(const Model& model, const TrainingOptions& options) {
  const AdamOptions& adam = options.adam;
  require(std::isfinite(adam.learning_rate) && adam.learning_rate >= 0, "learning-rate", adam.learning_rate,
          "0 or more");
  require(adam.beta1 >= 0 && adam.beta1 < 1, "beta1", adam.beta1, "0 to less than 1");
  require(adam.beta2 >= 0 && adam.beta2 < 1, "beta2", adam.beta2, "0 to less than 1");
  // With a smaller epsilon the factor of a step could be 0 in single precision, and a step 0 / 0.
  require(std::isfinite(adam.epsilon) && adam.epsilon >= 1e-30f, "epsilon", adam.epsilon, "1e-30 or more");
  require(std::isfinite(adam.l2_network) && adam.l2_network >= 0, "l2-network", adam.l2_network, "0 or more");
  require(std::isfinite(adam.decay_steps) && adam.decay_steps >= 0, "learning-decay", adam.decay_steps,
          "0 or more");
  require(options.average.decay >= 0 && options.average.decay < 1, "average-decay", options.average.decay,
          "0 to less than 1");
  require(std::isfinite(options.average.ramp) && options.average.ramp > 0, "average-ramp",
          options.average.ramp, "more than 0");
  require(std::isfinite(options.max_target) && options.max_target > 0, "max-target", options.max_target,
          "more than 0");
  if (model.config.encoding != FeatureEncoding::gate && options.counts_triangles())
    throw BadConfiguration({"feature-step", "", "it counts steps of triangles", "`encoding` gate"});
}

void check_state(const Model& model, const TrainingOptions& options, const ModelState& state) {
  const ParameterLayout& layout = model.parameters;
  const bool sparse = options.update == FeatureUpdate::sparse;
  check_size("parameters of the state", state.parameters.size(), layout.count);
  check_size("averages of the state", state.averages.size(), layout.count);
  check_size("first moments of the state", state.first_moments.size(), layout.count);
  check_size("second moments of the state", state.second_moments.size(), layout.count);
  check_size("node steps of the state", state.node_steps.size(), sparse ? layout.node_count : 0);
  check_size("triangle steps of the state", state.triangle_steps.size(),
             options.counts_triangles() ? model.gate.triangle_count : 0);
  require(state.steps >> 63 == 0, "steps", state.steps, "less than 2^63");
}

void check_state_numbers(const ModelState& state) {
  constexpr float kAny = std::numeric_limits<float>::lowest();
  check_numbers("parameters of the state", state.parameters, kAny, "finite numbers");
  check_numbers("averages of the state", state.averages, kAny, "finite numbers");
  check_numbers("first moments of the state", state.first_moments, kAny, "finite numbers");
  check_numbers("second moments of the state", state.second_moments, 0.0f, "finite numbers from 0 on");
}

}  // namespace gatelight::neural
