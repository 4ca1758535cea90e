#pragma once
// The initial output of the network.

#include <vector>

#include "neural/model/batch.h"
#include "neural/model/model.h"

namespace gatelight::neural {

/// For each output, the mean target of the accepted records. Targets are clamped to max_target and to a
/// hundred times the median magnitude of the non-zero targets: one bright record would raise the mean, and
/// Adam would need many steps to undo it. Empty if no record is accepted.
std::vector<double> start_mean(const Model& model, const TrainingBatch& batch, double max_target);

}  // namespace gatelight::neural
