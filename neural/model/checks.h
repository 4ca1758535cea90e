#pragma once
// Checks of the arguments of all backends, so that all throw the same errors.

#include "neural/model/backend.h"
#include "neural/model/state.h"

namespace gatelight::neural {

/// Throws BadConfiguration unless each span has one entry per point; spans that the model does not read may
/// be empty.
void check_batch(const Model& model, const QueryBatch& batch);
/// Also checks that there are size x outputs targets.
void check_batch(const Model& model, const TrainingBatch& batch);
/// Also checks that `out` has size x outputs floats.
void check_batch(const Model& model, const QueryBatch& batch, std::span<const float> out);

/// Throws BadConfiguration for options out of range, and for counts per triangle without the encoding `gate`.
void check_options(const Model& model, const TrainingOptions& options);

/// Throws BadConfiguration unless all arrays have the sizes that the model and options require and there are
/// fewer than 2^63 steps.
void check_state(const Model& model, const TrainingOptions& options, const ModelState& state);

/// Throws BadConfiguration for NaN, infinities and negative second moments, which training never makes.
/// Kernels read node 0 with weight 0 in place of missing nodes, so it must be finite.
void check_state_numbers(const ModelState& state);

}  // namespace gatelight::neural
