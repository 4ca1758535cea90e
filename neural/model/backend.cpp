#include "neural/model/backend.h"

#include "base/errors.h"

namespace gatelight::neural {

void Backend::start(std::span<const TrainingBatch> batches, Team* team) {
  for (const TrainingBatch& batch : batches)
    made_.push_back(team != nullptr ? train(batch, *team) : train(batch));
}

StepStatistics Backend::finish() {
  if (made_.empty()) throw BadConfiguration("finish: no step was started");
  const StepStatistics oldest = made_.front();
  made_.pop_front();
  return oldest;
}

}  // namespace gatelight::neural
