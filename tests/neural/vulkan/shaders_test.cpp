// Single shaders against the reference: the arrays that encode and train_network write.

#include "neural/reference/loss.h"
#include "neural/vulkan/feature_store.h"
#include "neural/vulkan/machine.h"
#include "neural/vulkan/model_tables.h"
#include "neural/vulkan/network_store.h"
#include "neural/vulkan/point_upload.h"
#include "neural/vulkan/step_commands.h"
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
        submission_(device_),
        tile(training_tile(model_, device_.limits().shared_bytes)),
        cut(cut_step(model_, batch.size(), tile)) {
    features_.import_from(transfer_, state);
    network_.import_from(transfer_, state);
    ModelBlock block;
    tables_.describe(block);
    features_.describe(block);
    network_.describe(block);
    model_block_ = make(sizeof(block) / 4);
    transfer_.write(model_block_, std::as_bytes(std::span(&block, 1)));
    const std::size_t records = batch.size(), parameters = model.parameters.network_count();
    inputs = make(records * model.parameters.inputs);
    status = make(records);
    keys = make(cut.references);
    weights = make(cut.references);
    triangles_ = make(records);
    gradients = make(records * model.parameters.feature_inputs);
    losses = make(cut.tiles);
    partials = make(cut.groups * parameters);
    statistics = make(glsl::kStatisticsWords);
    transfer_.fill(statistics, 0);
    upload(batch);
  }

  /// Runs one dispatch and waits for it.
  void run(Shader shader, const Constants& constants, std::uint64_t groups, std::uint32_t argument = 0) {
    Commands commands(submission_.commands.front(), machine_, model_block_.address(), batch_.address());
    commands.dispatch(shader, constants, groups, argument);
    commands.submit(submission_.fence);
    wait_for(device_, submission_.fence);
  }

  void write(const Buffer& to, const std::vector<float>& values) {
    transfer_.write(to, std::as_bytes(std::span(values)));
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
    block.keys[0] = keys.address();
    block.weights = weights.address();
    block.feature_gradients = gradients.address();
    block.losses = losses.address();
    block.partials = partials.address();
    block.statistics = statistics.address();
    block.forward = network_.forward();
    block.size = block.capacity = cut.size;
    block.references = cut.references;
    block.tiles = cut.tiles;
    block.groups = cut.groups;
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
  std::uint32_t tile;
  StepCut cut;
  Buffer inputs, status, keys, weights, gradients, losses, partials, statistics;
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
        {static_cast<std::uint32_t>(model.config.encoding), 0u, 1u, std::max(model.parameters.features, 1u)},
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

TEST_F(VulkanShaders, TrainNetworkFindsTheReferencesGradients) {
  std::uint64_t seed = 800;
  for (const char* name : {"nrc", "nao", "mlp_1x16", "mlp_3x64_no_biases", "mlp_5x128", "outputs_16",
                           "plain_256_inputs", "leaky_slope_0_percent"})
    for (const Loss loss : {Loss::l2, Loss::relative_l2}) {
      const ModelCase c = find_model_case(name);
      SCOPED_TRACE(fmt::format("{} loss {}", name, static_cast<int>(loss)));
      const Model& model = *c.model;
      TrainingOptions options;
      options.loss = loss;
      const ModelState state = random_state(model, options, ++seed, false);
      const OwnedBatch batch = make_smooth_batch(model, state, 150, seed, {.nonfinite = 0.05f});
      Bench bench(model, options, state, batch);
      const std::vector<double> parameters = widen(state.parameters);
      const std::size_t width = model.parameters.inputs, features = model.parameters.feature_inputs;
      std::vector<float> inputs(batch.size() * width, 0.0f);
      std::vector<double> sums(parameters.size(), 0.0);
      std::vector<float> expected_gradients;
      double expected_loss = 0;
      for (std::size_t r = 0; r < batch.size(); ++r) {
        if (record_status(model, batch.training(), r) != RecordStatus::accepted) {
          expected_gradients.insert(expected_gradients.end(), features, 0.0f);
          continue;
        }
        std::vector<double> x =
            reference::encode(model, parameters, reference::read_point(model, batch.points(), r));
        for (std::size_t i = 0; i < width; ++i) {
          inputs[i * batch.size() + r] = static_cast<float>(x[i]);
          x[i] = static_cast<double>(inputs[i * batch.size() + r]);
        }
        const reference::Activations activations = reference::forward(model, parameters, x);
        const std::size_t outputs = model.config.mlp.outputs;
        const std::vector<double> targets(
            batch.targets.begin() + static_cast<std::ptrdiff_t>(r * outputs),
            batch.targets.begin() + static_cast<std::ptrdiff_t>((r + 1) * outputs));
        const double denominator = reference::loss_denominator(loss, activations.back());
        expected_loss += reference::loss_value(activations.back(), targets, denominator);
        std::vector<double> d(outputs);
        reference::loss_gradient(activations.back(), targets, denominator, 1.0, d);
        const std::vector<double> dx = reference::backward(model, parameters, activations, d, sums);
        for (std::size_t i = 0; i < features; ++i) expected_gradients.push_back(static_cast<float>(dx[i]));
      }
      bench.run(Shader::encode,
                {static_cast<std::uint32_t>(model.config.encoding), 0u, 1u,
                 std::max(model.parameters.features, 1u)},
                groups_for(batch.size()));  // for the records' status
      bench.write(bench.inputs, inputs);
      bench.run(Shader::pack_network, {}, groups_for(model.parameters.network_count()), glsl::kPackBackward);
      Constants constants = network_constants(model);
      constants.insert(constants.end(),
                       {bench.tile, std::bit_cast<std::uint32_t>(model.config.mlp.leaky_slope),
                        loss == Loss::relative_l2 ? 1u : 0u});
      bench.run(Shader::train_network, constants, bench.cut.groups);

      const std::size_t count = model.parameters.network_count();
      const auto partials = bench.read<float>(bench.partials, bench.cut.groups * count);
      std::vector<float> got(model.parameters.count, 0.0f), expected(model.parameters.count, 0.0f);
      for (std::size_t p = 0; p < count; ++p) {
        double sum = 0;
        for (std::size_t g = 0; g < bench.cut.groups; ++g)
          sum += static_cast<double>(partials[g * count + p]);
        got[model.parameters.network + p] = static_cast<float>(sum);
        expected[model.parameters.network + p] = static_cast<float>(sums[model.parameters.network + p]);
      }
      const std::vector<bool> none(model.parameters.node_count, true);
      EXPECT_LE(tensor_difference(model, got, expected, none), kTolerance);
      EXPECT_LE(relative_difference(bench.read<float>(bench.gradients, batch.size() * features),
                                    expected_gradients),
                kTolerance);
      double losses = 0;
      for (const float tile : bench.read<float>(bench.losses, bench.cut.tiles))
        losses += static_cast<double>(tile);
      EXPECT_NEAR(losses, expected_loss, 1e-5 * expected_loss);
    }
}

}  // namespace
}  // namespace gatelight::neural::vulkan
