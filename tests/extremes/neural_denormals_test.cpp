// Denormal floats: flushed by every thread that computes, whatever its control word was.

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstring>

#include "base/platform/flush_denormals.h"
#include "tests/extremes/fast_backends.h"

namespace gatelight::neural {
namespace {

using namespace testing;

/// Sets the control word of this thread and restores the old one.
class ControlWord {
 public:
  explicit ControlWord(bool flushing) : before_(float_control()) {
    set_float_control(flushing ? before_ | kFlushBits : before_ & ~kFlushBits);
  }
  ~ControlWord() { set_float_control(before_); }

 private:
  std::uint64_t before_;
};

bool is_denormal(float x) {
  std::uint32_t word;
  std::memcpy(&word, &x, sizeof word);
  return (word & 0x7f800000u) == 0 && (word & 0x007fffffu) != 0;
}

std::size_t denormals_in(std::span<const float> values) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), is_denormal));
}

/// Runs `f` in an arena of `threads` threads, made by a thread that flushes denormals or does not.
template <class F>
void in_arena(int threads, bool flushing, const F& f) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(threads));
  const ControlWord word(flushing);
  tbb::task_arena(threads).execute(f);
}

/// Weights and targets so small that activations and gradients would be denormal.
ModelState tiny_state(const Model& model, const TrainingOptions& options) {
  ModelState state = random_state(model, options, 1, false);
  for (float& p : state.parameters) p *= 1e-19f;
  state.averages = state.parameters;
  return state;
}

TEST(Denormals, TheControlWordIsRestored) {
  for (const bool flushing : {false, true}) {
    const ControlWord word(flushing);
    const std::uint64_t before = float_control() & kFlushBits;
    {
      const FlushDenormals flush;
      EXPECT_EQ(float_control() & kFlushBits, kFlushBits);
      volatile float least = std::numeric_limits<float>::min();
      EXPECT_EQ(least / 2, 0.0f);
    }
    EXPECT_EQ(float_control() & kFlushBits, before);
    const ModelCase c = find_model_case("nrc");
    const auto backend = cpu::make_cpu_backend(c.model, {});
    const OwnedBatch batch = make_batch(*c.model, 3000, 1);
    backend->train(batch.training());
    raw_answers(*backend, *c.model, batch);
    EXPECT_EQ(float_control() & kFlushBits, before);
  }
}

TEST(Denormals, StepsAndAnswersHaveTheSameBitsForAnyModeOfTheThreads) {
  std::size_t made = 0;
  for (const char* name : {"nrc", "nao", "hash_F4"}) {
    const ModelCase c = find_model_case(name);
    for (const FeaturePrecision precision : {FeaturePrecision::fp32, FeaturePrecision::fp16}) {
      TrainingOptions options;
      options.loss = Loss::l2;
      options.precision = precision;
      options.start_at_mean = false;
      options.adam.l2_network = 0;
      const ModelState start = tiny_state(*c.model, options);
      OwnedBatch batch = make_batch(*c.model, 3001, 1, {.border = 0.3f});
      for (float& target : batch.targets) target *= 1e-38f;
      for (const simd::Isa isa : simd::available_isas()) {
        ModelState expected;
        std::vector<float> answers;
        for (const int threads : {1, 2, 7})
          for (const bool flushing : {true, false}) {
            SCOPED_TRACE(fmt::format("{} {} {} threads, {}", name, isa_name(isa), threads, flushing));
            ModelState got;
            std::vector<float> out;
            in_arena(threads, flushing, [&] {
              const auto backend = cpu::make_cpu_backend(c.model, options, isa);
              backend->import_state(start);
              for (int step = 0; step < 4; ++step) backend->train(batch.training());
              got = backend->export_state();
              out = raw_answers(*backend, *c.model, batch);
            });
            if (expected.parameters.empty()) {
              expected = got;
              answers = out;
              made += denormals_in(out) + denormals_in(got.first_moments) + denormals_in(got.second_moments);
            }
            EXPECT_TRUE(got == expected);
            EXPECT_EQ(std::memcmp(out.data(), answers.data(), out.size() * sizeof(float)), 0);
          }
      }
    }
  }
  EXPECT_EQ(made, 0u);
}

TEST(Denormals, SmallWeightsAgreeWithTheReference) {
  for (const float scale : {1e-10f, 1e-19f, 1e-30f, 1e-38f}) {
    const ModelCase c = find_model_case("nrc");
    ModelState state = random_state(*c.model, {}, 2, false);
    for (std::uint64_t i = 0; i < c.model->parameters.network; ++i)
      state.parameters[i] = state.averages[i] *= scale;
    const OwnedBatch batch = make_batch(*c.model, 997, 2, {.border = 0.3f});
    EXPECT_LE(worst_answers(c, {}, state, batch), kTolerance) << scale;
  }
}

}  // namespace
}  // namespace gatelight::neural
