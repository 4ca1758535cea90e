// write_cache_sample FILE fp32|fp16: a small cache file with known numbers, for check_safetensors.

#include <string>

#include "neural/trainer.h"
#include "tests/support/model_cases.h"
#include "tests/support/stored_state.h"

namespace gatelight::neural::testing {
namespace {

void write_sample(const std::string& path, bool half) {
  const ModelCase c = make_case("sample", default_hash_config());
  const TrainingOptions options{.precision = half ? FeaturePrecision::fp16 : FeaturePrecision::fp32};
  ModelState state = initial_state(*c.model, options);
  for (std::size_t i = 0; i < state.parameters.size(); ++i) {
    const float number = static_cast<float>(i % 2048) / 8;  // exact in fp16
    state.parameters[i] = -number;
    state.averages[i] = number + 1000;
    state.first_moments[i] = number - 2000;
    state.second_moments[i] = number + 3000;
  }
  for (std::size_t i = 0; i < state.node_steps.size(); ++i)
    state.node_steps[i] = static_cast<std::uint32_t>(3 * i + 1);
  state.steps = 123456789012345;
  const Trainer trainer(c.model, options, std::make_unique<StoredState>(c.model, options, state));
  trainer.save(path, "a \"scene\"\n\u00e9");
}

}  // namespace
}  // namespace gatelight::neural::testing

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  gatelight::neural::testing::write_sample(argv[1], std::string(argv[2]) == "fp16");
  return 0;
}
