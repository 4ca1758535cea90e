// Answers and a step of every model that the library allows agree with the reference. The test is slow on a
// software device, which compiles a pipeline for each shape of a network.

#include "tests/neural/vulkan/agreement.h"

namespace gatelight::neural {
namespace {

using namespace testing;

class VulkanEveryModel : public AgreesOnVulkan {};

// Tiles hold up to 64 points.
constexpr std::size_t kSizes[] = {1, 63, 64, 65, 97, 130, 7};

TEST_F(VulkanEveryModel, AnswersAgree) {
  std::uint64_t seed = 1;
  for (const ModelCase& c : all_model_cases()) {
    const TrainingOptions options;
    const ModelState state = random_state(*c.model, options, ++seed, true);
    const OwnedBatch batch = make_batch(*c.model, kSizes[seed % std::size(kSizes)], seed,
                                        {.nonfinite = 0.1f, .unstored = 0.1f, .border = 0.3f, .crowded = 0});
    agreement().expect_same_answers(c, options, batch, state);
  }
}

TEST_F(VulkanEveryModel, AStepAgrees) {
  std::uint64_t seed = 100;
  for (const ModelCase& c : all_model_cases()) {
    const TrainingOptions options = smooth_options();
    const ModelState state = random_state(*c.model, options, ++seed, false);
    const OwnedBatch batch =
        make_smooth_batch(*c.model, state, 60 + seed % 41, seed, {.nonfinite = 0.1f, .unstored = 0.1f});
    agreement().expect_same_step(c.name, c.model, options, batch, state);
  }
}

}  // namespace
}  // namespace gatelight::neural
