#pragma once
// Checks that the kernels and the device pass alike.

#include <initializer_list>

#include "tests/support/agreement.h"

namespace gatelight::neural::testing {

/// A step under every training option, from a fresh and from a trained state.
inline void expect_same_step_under_options(Agreement& agreement, std::initializer_list<const char*> names,
                                           std::initializer_list<Loss> losses) {
  std::uint64_t seed = 300;
  for (const char* name : names) {
    const ModelCase c = find_model_case(name);
    for (const auto& [word, choice] : all_training_options(*c.model))
      for (const Loss loss : losses)
        for (const bool trained : {false, true}) {
          TrainingOptions options = choice;
          make_smooth(options.adam);
          if (options.loss == Loss::relative_l2) options.loss = loss;
          const ModelState state = random_state(*c.model, options, ++seed, trained);
          OwnedBatch batch = make_smooth_batch(*c.model, state, 60 + seed % 41, seed,
                                               {.nonfinite = 0.1f, .unstored = 0.1f, .beyond = 0.05f});
          options.max_target = 8.0f;
          // At the first step the mean target becomes the output's bias: let it be far from each target.
          const bool start_at_mean = options.start_at_mean && !trained;
          for (std::size_t i = 0; start_at_mean && i < batch.targets.size(); i += 2) batch.targets[i] -= 3.0f;
          agreement.expect_same_step(fmt::format("{} {}", c.name, word), c.model, options, batch, state);
        }
  }
}

/// Answers within their ranges of a backend of the model "nrc" with default options.
inline void expect_clamped_answers(Backend& backend, QueryPrecision precision) {
  const ModelCase c = find_model_case("nrc");
  ModelState state = random_state(*c.model, {}, 4, true);
  for (std::uint32_t o = 0; o < 3; ++o) state.averages[c.model->parameters.layers.back().biases + o] = 0.4f;
  backend.import_state(state);
  const OwnedBatch batch = make_batch(*c.model, 211, 4, {.nonfinite = 0.1f, .unstored = 0.1f});
  const auto ask = [&](OutputRange range) {
    return answers(backend, *c.model, batch, {precision, range, true});
  };
  const std::vector<float> raw = ask(OutputRange::raw), positive = ask(OutputRange::non_negative),
                           unit = ask(OutputRange::unit);
  expect_ranges(*c.model, batch, raw, positive, unit);
}

}  // namespace gatelight::neural::testing
