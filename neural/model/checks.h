#pragma once
// What every backend checks at its door, so that all refuse the same things in the same words.

#include "neural/model/backend.h"
#include "neural/model/state.h"

namespace gatelight::neural {

/// Throws BadConfiguration when a span that the model reads has not one entry a point, or another one has
/// neither that nor none.
void check_batch(const Model& model, const QueryBatch& batch);
/// And when there are not size x outputs targets.
void check_batch(const Model& model, const TrainingBatch& batch);
/// And when `out` has not size x outputs floats.
void check_batch(const Model& model, const QueryBatch& batch, std::span<const float> out);

/// Throws BadConfiguration for options out of range, or a counter per triangle without triangles.
void check_options(const Model& model, const TrainingOptions& options);

/// Throws BadConfiguration when an array has not the size that the model and options ask for, or the steps
/// are so many that counting them would end.
void check_state(const Model& model, const TrainingOptions& options, const ModelState& state);

/// Throws BadConfiguration for numbers that no training makes: NaN, infinities, negative second moments.
/// Kernels read node 0 in place of nodes that are not there, with weight 0.
void check_state_numbers(const ModelState& state);

}  // namespace gatelight::neural
