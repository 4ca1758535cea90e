// A single shader against the reference: the arrays that `encode` writes.

#include "neural/vulkan/commands.h"
#include "neural/vulkan/feature_store.h"
#include "neural/vulkan/machine.h"
#include "neural/vulkan/model_tables.h"
#include "neural/vulkan/network_store.h"
#include "neural/vulkan/point_upload.h"
#include "neural/vulkan/submission.h"
#include "tests/neural/vulkan/agreement.h"

namespace gatelight::neural::vulkan {
namespace {

using namespace neural::testing;

using Constants = std::vector<std::uint32_t>;

class VulkanShaders : public OnVulkan {};

/// A model and a batch on the device, with arrays that a test can read.
class Bench {
 public:
  Bench(const Model& model, const TrainingOptions& options, const ModelState& state, const OwnedBatch& batch)
      : model_(model),
        options_(options),
        machine_(*test_machine()),
        device_(machine_.device()),
        transfer_(device_),
        tables_(device_, transfer_, model_, options_, device_.limits().longest_buffer),
        features_(device_, transfer_, model_, options_, device_.limits().longest_buffer),
        network_(device_, transfer_, model_, options_),
        submission_(device_) {
    features_.import_from(transfer_, state);
    network_.import_from(transfer_, state);
    ModelBlock block;
    tables_.describe(block);
    features_.describe(block);
    network_.describe(block);
    model_block_ = make(sizeof(block) / 4);
    transfer_.write(model_block_, std::as_bytes(std::span(&block, 1)));
    const std::size_t records = batch.size(), references = records * model.nodes_per_point();
    inputs = make(records * model.parameters.inputs);
    status = make(records);
    keys = make(references);
    weights = make(references);
    triangles_ = make(records);
    statistics = make(glsl::kStatisticsWords);
    transfer_.fill(statistics, 0);
    upload(batch);
  }

  /// Runs one dispatch and waits for it.
  void run(Shader shader, const Constants& constants, std::uint64_t groups) {
    Commands commands(submission_.commands.front(), machine_, model_block_.address(), batch_.address());
    commands.dispatch(shader, constants, groups);
    commands.submit(submission_.fence);
    wait_for(device_, submission_.fence);
  }

  template <class T>
  std::vector<T> read(const Buffer& from, std::size_t count) {
    std::vector<T> values(count);
    transfer_.read(from, std::as_writable_bytes(std::span(values)));
    return values;
  }

 private:
  Buffer make(std::size_t words) { return {device_, 4 * words, BufferUse::device}; }

  void upload(const OwnedBatch& batch) {
    BatchBlock block;
    block.read = features_.readable(false);
    block.inputs = inputs.address();
    block.status = status.address();
    block.record_triangles = triangles_.address();
    block.keys = keys.address();
    block.weights = weights.address();
    block.statistics = statistics.address();
    block.size = block.capacity = static_cast<std::uint32_t>(batch.size());
    block.references = block.size * model_.nodes_per_point();
    const std::uint64_t bytes = upload_bytes(model_, batch.size(), true);
    std::vector<std::byte> staging(bytes);
    batch_ = make(bytes / 4);
    write_upload(model_, batch.points(), batch.targets, 0, batch_.address(), block, staging.data());
    transfer_.write(batch_, staging);
  }

  const Model& model_;
  const TrainingOptions& options_;
  Machine& machine_;
  const Device& device_;
  Transfer transfer_;
  ModelTables tables_;
  FeatureStore features_;
  NetworkStore network_;
  Submission submission_;
  Buffer model_block_, batch_, triangles_;

 public:
  Buffer inputs, status, keys, weights, statistics;
};

// A float position among 64 bins has six bits fewer, one among a level's 256 cells eight.
constexpr double kEncodeTolerance = 1e-5;
constexpr double kHashGridTolerance = 3e-5;

TEST_F(VulkanShaders, EncodeFindsTheReferencesNodesAndInputs) {
  std::uint64_t seed = 700;
  for (const ModelCase& c : all_model_cases()) {
    if (c.name.starts_with("mlp") || c.name.starts_with("outputs") || c.name.starts_with("leaky")) continue;
    SCOPED_TRACE(c.name);
    const Model& model = *c.model;
    const TrainingOptions options;
    const ModelState state = random_state(model, options, ++seed, false);
    const OwnedBatch batch = make_batch(model, 150, seed, {.nonfinite = 0.05f, .unstored = 0.05f});
    Bench bench(model, options, state, batch);
    bench.run(
        Shader::encode,
        {static_cast<std::uint32_t>(model.config.encoding), 0u, std::max(model.parameters.features, 1u)},
        groups_for(batch.size()));
    const std::size_t slots = model.nodes_per_point(), width = model.parameters.inputs;
    const auto inputs = bench.read<float>(bench.inputs, batch.size() * width);
    const auto status = bench.read<std::uint32_t>(bench.status, batch.size());
    const auto keys = bench.read<std::uint32_t>(bench.keys, batch.size() * slots);
    const auto weights = bench.read<float>(bench.weights, batch.size() * slots);
    const auto counts = bench.read<std::uint32_t>(bench.statistics, glsl::kStatisticsWords);
    EXPECT_EQ(counts[glsl::kRejected], batch.count(Fate::rejected));
    EXPECT_EQ(counts[glsl::kUnstored], batch.count(Fate::unstored));
    const std::vector<double> parameters = widen(state.parameters);
    std::vector<float> got, expected;
    for (std::size_t r = 0; r < batch.size(); ++r) {
      EXPECT_EQ(status[r], static_cast<std::uint32_t>(record_status(model, batch.training(), r)));
      if (status[r] == static_cast<std::uint32_t>(RecordStatus::rejected)) continue;
      const reference::Point point = reference::read_point(model, batch.points(), r);
      const std::vector<double> encoded = reference::encode(model, parameters, point);
      for (std::size_t i = 0; i < width; ++i) {
        got.push_back(inputs[i * batch.size() + r]);
        expected.push_back(static_cast<float>(encoded[i]));
      }
      // The nodes are the same, except near a line between cells, where the weights of others are small.
      const auto nodes = reference::encoding_nodes(model, point);
      for (std::size_t s = 0; s < nodes.size(); ++s)
        if (nodes[s].weight > 1e-3) {
          EXPECT_EQ(keys[r * slots + s], nodes[s].node) << "record " << r << " slot " << s;
        }
      double sum = 0;
      for (std::size_t s = 0; s < slots; ++s) sum += static_cast<double>(weights[r * slots + s]);
      EXPECT_NEAR(sum, nodes.empty() ? 0.0 : model.levels(), 1e-5);
    }
    EXPECT_LE(relative_difference(got, expected),
              model.config.encoding == FeatureEncoding::hash_grid ? kHashGridTolerance : kEncodeTolerance);
  }
}

}  // namespace
}  // namespace gatelight::neural::vulkan
