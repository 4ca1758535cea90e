#pragma once
// Where the network's answers start.

#include <vector>

#include "neural/base/batch.h"
#include "neural/model/model.h"

namespace gatelight::neural {

/// For each output the mean target of the records that are learned from, clamped to max_target; none counts
/// for more than a hundred times the median magnitude of those that are not 0: Adam would take as many steps
/// to forget one bright record as the mean is too great. Empty without such records.
std::vector<double> start_mean(const Model& model, const TrainingBatch& batch, double max_target);

}  // namespace gatelight::neural
