#include "neural/reference/reference_backend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/clock.h"
#include "base/half.h"
#include "neural/learning/adam.h"
#include "neural/learning/record_status.h"
#include "neural/learning/start_mean.h"
#include "neural/model/checks.h"
#include "neural/reference/adam.h"
#include "neural/reference/encode.h"
#include "neural/reference/record_gradient.h"

namespace gatelight::neural::reference {

namespace {

struct Record {
  Point point;
  std::vector<double> targets;
};

double round_to_half(double value) {
  return half_to_float(float_to_finite_half(static_cast<float>(value)));
}

void count_up(std::uint32_t& counter) {
  if (counter != std::numeric_limits<std::uint32_t>::max()) ++counter;
}

/// Returns the accepted records and counts the others.
std::vector<Record> accept_records(const Model& model, const TrainingBatch& batch, double max_target,
                                   StepStatistics& statistics) {
  std::vector<Record> records;
  const std::size_t outputs = model.config.mlp.outputs;
  for (std::size_t r = 0; r < batch.points.size; ++r) {
    const RecordStatus status = record_status(model, batch, r);
    if (status == RecordStatus::rejected) ++statistics.rejected;
    if (status == RecordStatus::unstored) ++statistics.unstored;
    if (status != RecordStatus::accepted) continue;
    const std::span<const float> targets = batch.targets.subspan(r * outputs, outputs);
    Record record{read_point(model, batch.points, r), {targets.begin(), targets.end()}};
    bool clipped = false;
    for (double& target : record.targets) {
      clipped = clipped || std::abs(target) > max_target;
      target = std::clamp(target, -max_target, max_target);
    }
    if (clipped) ++statistics.clipped;
    records.push_back(std::move(record));
  }
  statistics.records = records.size();
  return records;
}

float in_range(double output, OutputRange range) {
  const float value = static_cast<float>(output);
  if (range == OutputRange::raw) return value;
  if (!std::isfinite(value)) return 0.0f;
  return range == OutputRange::unit ? std::clamp(value, 0.0f, 1.0f) : std::max(value, 0.0f);
}

class ReferenceBackend final : public Backend {
 public:
  ReferenceBackend(std::shared_ptr<const Model> model, const TrainingOptions& options)
      : model_(std::move(model)), options_(options) {
    check_options(*model_, options_);
    import_state(initial_state(*model_, options_));
  }

  StepStatistics train(const TrainingBatch& batch) override;
  void query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const override;
  ModelState export_state() const override;
  void import_state(const ModelState& state) override;
  std::string name() const override { return "reference"; }
  std::uint64_t parameter_bytes() const override { return parameters_.size() * sizeof(double); }
  std::uint64_t optimizer_bytes() const override {
    return averages_.size() * sizeof(double) + moments_.size() * sizeof(Moments) +
           (node_steps_.size() + triangle_steps_.size()) * sizeof(std::uint32_t);
  }

 private:
  bool is_network(std::size_t parameter) const { return parameter >= model_->parameters.network; }
  std::vector<double> readable(std::vector<double> parameters) const;
  void start_output_bias(const TrainingBatch& batch);
  void update_network(std::span<const double> gradients, StepStatistics& statistics);
  void update_features(std::span<const Record> records, std::span<const double> gradients,
                       StepStatistics& statistics);
  void update(std::size_t parameter, std::uint64_t t, double gradient);
  void count_triangles(std::span<const Record> records);

  std::uint32_t triangle_number(const Point& point) const {
    return model_->gate.surfaces[point.surface].first_triangle + point.triangle;
  }

  std::shared_ptr<const Model> model_;
  TrainingOptions options_;
  std::vector<double> parameters_;  ///< the masters with fp16_masters
  std::vector<double> averages_;
  std::vector<Moments> moments_;
  std::vector<std::uint32_t> node_steps_;
  std::vector<std::uint32_t> triangle_steps_;
  std::uint64_t steps_ = 0;
};

StepStatistics ReferenceBackend::train(const TrainingBatch& batch) {
  check_batch(*model_, batch);
  const auto start = Clock::now();
  StepStatistics statistics;
  const std::vector<Record> records = accept_records(*model_, batch, options_.max_target, statistics);
  if (records.empty()) return statistics;
  if (steps_ == 0 && options_.start_at_mean && model_->parameters.biases) start_output_bias(batch);

  const std::vector<double> parameters = readable(parameters_);
  std::vector<double> gradients(parameters.size(), 0.0);
  const double values = static_cast<double>(records.size()) * model_->config.mlp.outputs;
  for (const Record& record : records)
    statistics.loss += add_record_gradient(*model_, options_.loss, parameters, record.point, record.targets,
                                           1.0 / values, gradients);
  statistics.loss /= values;
  statistics.seconds_network = seconds_since(start);

  ++steps_;
  count_triangles(records);
  update_network(gradients, statistics);
  update_features(records, gradients, statistics);
  statistics.seconds = seconds_since(start);
  statistics.seconds_update = statistics.seconds - statistics.seconds_network;
  return statistics;
}

/// The parameters that forward and queries read: features are rounded to fp16 if so configured.
std::vector<double> ReferenceBackend::readable(std::vector<double> parameters) const {
  if (options_.precision != FeaturePrecision::fp32)
    for (std::size_t p = 0; !is_network(p); ++p) parameters[p] = round_to_half(parameters[p]);
  return parameters;
}

void ReferenceBackend::start_output_bias(const TrainingBatch& batch) {
  const LayerLayout& layer = model_->parameters.layers.back();
  const std::vector<double> means = start_mean(*model_, batch, options_.max_target);
  for (std::size_t o = 0; o < layer.outputs; ++o)
    parameters_[layer.biases + o] = averages_[layer.biases + o] = means[o];
}

void ReferenceBackend::count_triangles(std::span<const Record> records) {
  if (triangle_steps_.empty()) return;
  std::vector<bool> touched(triangle_steps_.size(), false);
  for (const Record& record : records) touched[triangle_number(record.point)] = true;
  for (std::size_t t = 0; t < touched.size(); ++t)
    if (touched[t]) count_up(triangle_steps_[t]);
}

/// Applies Adam with step count t, then updates the average.
void ReferenceBackend::update(std::size_t parameter, std::uint64_t t, double gradient) {
  const bool network = is_network(parameter);
  const bool half = !network && options_.precision != FeaturePrecision::fp32;
  const bool only_half = !network && options_.precision == FeaturePrecision::fp16;
  double& p = parameters_[parameter];
  double& average = averages_[parameter];
  p = adam(options_.adam, t, p, gradient, moments_[parameter]);
  if (half) p = std::clamp<double>(p, -kMaxHalf, kMaxHalf);
  if (only_half) p = round_to_half(p);
  if (network ? options_.average.network : options_.average.features) {
    average += average_rate(options_.average, t) * (p - average);
    if (only_half) average = round_to_half(average);
  } else {
    average = p;
  }
}

void ReferenceBackend::update_network(std::span<const double> gradients, StepStatistics& statistics) {
  for (const LayerLayout& layer : model_->parameters.layers) {
    const std::size_t end = layer.biases + (model_->parameters.biases ? layer.outputs : 0);
    for (std::size_t p = layer.weights; p < end; ++p) {
      const double l2 = p < layer.biases ? options_.adam.l2_network : 0.0;
      const double gradient = gradients[p] + l2 * parameters_[p];
      if (std::isfinite(gradient))
        update(p, steps_, gradient);
      else
        ++statistics.skipped_updates;
    }
  }
}

void ReferenceBackend::update_features(std::span<const Record> records, std::span<const double> gradients,
                                       StepStatistics& statistics) {
  // The largest count of the triangles that touch a node; 1 if triangles are not counted, 0 for untouched
  // nodes.
  std::vector<std::uint32_t> touched(model_->parameters.node_count, 0);
  for (const Record& record : records) {
    const std::uint32_t count = triangle_steps_.empty() ? 1 : triangle_steps_[triangle_number(record.point)];
    for (const NodeWeight& node : encoding_nodes(*model_, record.point))
      if (node.weight != 0.0) touched[node.node] = std::max(touched[node.node], count);
  }
  const std::size_t features = model_->parameters.features;
  const bool sparse = options_.update == FeatureUpdate::sparse;
  for (std::size_t node = 0; node < touched.size(); ++node) {
    if (touched[node] != 0) ++statistics.touched_nodes;
    if (sparse && touched[node] == 0) continue;
    const std::span<const double> gradient = gradients.subspan(node * features, features);
    if (!std::all_of(gradient.begin(), gradient.end(), [](double g) { return std::isfinite(g); })) {
      ++statistics.skipped_updates;
      continue;
    }
    if (sparse && options_.feature_step == FeatureStep::per_triangle) node_steps_[node] = touched[node];
    if (sparse && options_.feature_step == FeatureStep::per_node) count_up(node_steps_[node]);
    const std::uint64_t t = sparse ? node_steps_[node] : steps_;
    for (std::size_t l = 0; l < features; ++l) update(node * features + l, t, gradient[l]);
  }
}

void ReferenceBackend::query(const QueryBatch& batch, const QueryOptions& options,
                             std::span<float> out) const {
  check_batch(*model_, batch, out);
  const std::vector<double> parameters = readable(options.averaged ? averages_ : parameters_);
  const std::size_t count = model_->config.mlp.outputs;
  for (std::size_t r = 0; r < batch.size; ++r) {
    std::vector<double> outputs(count, std::numeric_limits<double>::quiet_NaN());
    if (is_finite(*model_, batch, r)) outputs = evaluate(*model_, parameters, read_point(*model_, batch, r));
    for (std::size_t o = 0; o < count; ++o) out[r * count + o] = in_range(outputs[o], options.range);
  }
}

ModelState ReferenceBackend::export_state() const {
  const auto narrow = [](double value) { return static_cast<float>(value); };
  ModelState state;
  state.parameters.resize(parameters_.size());
  std::transform(parameters_.begin(), parameters_.end(), state.parameters.begin(), narrow);
  state.averages.resize(averages_.size());
  std::transform(averages_.begin(), averages_.end(), state.averages.begin(), narrow);
  for (const Moments& moments : moments_) {
    state.first_moments.push_back(narrow(moments.first));
    state.second_moments.push_back(narrow(moments.second));
  }
  state.node_steps = node_steps_;
  state.triangle_steps = triangle_steps_;
  state.steps = steps_;
  return state;
}

void ReferenceBackend::import_state(const ModelState& state) {
  check_state(*model_, options_, state);
  parameters_.assign(state.parameters.begin(), state.parameters.end());
  averages_.assign(state.averages.begin(), state.averages.end());
  if (options_.precision == FeaturePrecision::fp16) {
    parameters_ = readable(std::move(parameters_));
    averages_ = readable(std::move(averages_));
  }
  moments_.resize(parameters_.size());
  for (std::size_t p = 0; p < moments_.size(); ++p)
    moments_[p] = {state.first_moments[p], state.second_moments[p]};
  node_steps_ = state.node_steps;
  triangle_steps_ = state.triangle_steps;
  steps_ = state.steps;
}

}  // namespace

std::unique_ptr<Backend> make_reference_backend(std::shared_ptr<const Model> model,
                                                const TrainingOptions& options) {
  return std::make_unique<ReferenceBackend>(std::move(model), options);
}

}  // namespace gatelight::neural::reference
