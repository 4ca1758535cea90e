#include "neural/learning/start_mean.h"

#include <algorithm>
#include <cmath>

#include "neural/learning/record_status.h"

namespace gatelight::neural {

namespace {

constexpr double kMedians = 100.0;

double mean_of(const std::vector<double>& targets, double most) {
  std::vector<double> lit;
  for (const double t : targets)
    if (t != 0.0) lit.push_back(std::abs(t));
  if (!lit.empty()) {
    const auto middle = lit.begin() + static_cast<std::ptrdiff_t>(lit.size() / 2);
    std::nth_element(lit.begin(), middle, lit.end());
    most = std::min(most, kMedians * *middle);
  }
  double sum = 0.0;
  for (const double t : targets) sum += std::clamp(t, -most, most);
  return sum / static_cast<double>(targets.size());
}

}  // namespace

std::vector<double> start_mean(const Model& model, const TrainingBatch& batch, double max_target) {
  const std::size_t outputs = model.config.mlp.outputs;
  std::vector<std::size_t> records;
  for (std::size_t r = 0; r < batch.points.size; ++r)
    if (record_status(model, batch, r) == RecordStatus::accepted) records.push_back(r);
  std::vector<double> means;
  if (records.empty()) return means;
  std::vector<double> targets(records.size());
  for (std::size_t o = 0; o < outputs; ++o) {
    for (std::size_t i = 0; i < records.size(); ++i) targets[i] = batch.targets[records[i] * outputs + o];
    means.push_back(mean_of(targets, max_target));
  }
  return means;
}

}  // namespace gatelight::neural
