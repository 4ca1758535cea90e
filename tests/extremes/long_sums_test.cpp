// Numbers of the renderer: a million samples a pixel; denormal floats, which its threads flush, whatever the
// caller does.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <set>
#include <thread>

#include "base/platform/flush_denormals.h"
#include "renderer/film/film.h"
#include "renderer/render.h"
#include "tests/support/room.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Random;
using testing::room;

constexpr int kSamples = 1'000'000;

/// Compensated sum of doubles (Neumaier 1974).
class ExactSum {
 public:
  void add(double value) {
    const double sum = sum_ + value;
    lost_ += std::abs(sum_) >= std::abs(value) ? (sum_ - sum) + value : (value - sum) + sum_;
    sum_ = sum;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0.0;
  double lost_ = 0.0;
};

float mean_of(const Film& film) {
  return film.resolve().layers[0].values[0];
}

float variance_of(const Film& film) {
  return film.resolve().find("variance")->values[0];
}

const FilmContents kVariance = {.aovs = {Aov::variance}};

TEST(LongSums, TheMeanOfAMillionEqualSamplesIsExact) {
  for (const float value : {1e-30f, 1e-6f, 0.1f, 1.0f / 3.0f, 0.7f, 1.0f, 1e6f, 1e30f}) {
    Film film({0, 0, 1, 1}, 1, 1, kVariance);
    for (int i = 0; i < kSamples; ++i) film.add(film.take({0, 0}), Color::Constant(value));
    EXPECT_EQ(mean_of(film), value);
    EXPECT_LT(std::sqrt(static_cast<double>(variance_of(film))), 1e-8 * static_cast<double>(value));
  }
}

TEST(LongSums, AMillionRandomSamplesHaveTheMeanAndVarianceOfTheirExactSums) {
  // Uniform, and powers that let a few samples of 1e6 and more carry all the light.
  for (const double power : {0.0, 1.0, 4.0, 12.0}) {
    Film film({0, 0, 1, 1}, 1, 1, kVariance);
    Random random(7);
    std::vector<float> values;
    ExactSum sum;
    for (int i = 0; i < kSamples; ++i) {
      const double u = random.uniform(1e-12, 1.0);
      values.push_back(static_cast<float>(power == 0.0 ? 1e-6 * u : std::pow(10.0, power * u - 6.0)));
      film.add(film.take({0, 0}), Color::Constant(values.back()));
      sum.add(static_cast<double>(values.back()));
    }
    const double mean = sum.value() / kSamples;
    ExactSum squares;
    for (const float value : values) squares.add((value - mean) * (value - mean));
    const double variance = squares.value() / (double{kSamples} * (kSamples - 1.0));
    EXPECT_NEAR(static_cast<double>(mean_of(film)) / mean, 1.0, 0x1p-23) << power;
    EXPECT_NEAR(static_cast<double>(variance_of(film)) / variance, 1.0, 1e-6) << power;
  }
}

TEST(RendererDenormals, EveryThreadFlushesAndTheCallersControlWordIsKept) {
  const scene::Scene s = room();
  std::size_t most = 0;
  std::vector<std::vector<float>> pictures;
  const auto render = [&](bool flushing, Integrator integrator, int spp) {
    RenderOptions options = testing::small_picture();
    options.integrator = integrator;
    options.threads = 4;
    options.spp = spp;
    const std::uint64_t before = float_control();
    set_float_control(flushing ? before | kFlushBits : before & ~kFlushBits);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    std::atomic<int> without{0};
    Renderer renderer(s, options);
    // Called by the thread that has finished a tile.
    const Picture picture = renderer.render({.stop = [&] {
      if ((float_control() & kFlushBits) != kFlushBits) ++without;
      const std::lock_guard lock(mutex);
      threads.insert(std::this_thread::get_id());
      return false;
    }});
    EXPECT_EQ(float_control() & kFlushBits, flushing ? kFlushBits : std::uint64_t{0});
    set_float_control(before);
    EXPECT_EQ(without, 0);
    most = std::max(most, threads.size());
    return picture.layers[0].values;
  };
  for (const bool flushing : {false, true})
    for (const Integrator integrator : {Integrator::path, Integrator::ao})
      pictures.push_back(render(flushing, integrator, 8));
  // On a busy machine one thread may have done all of so small a picture before another woke up.
  for (int spp = 16; spp <= 1 << 15 && most < 2; spp *= 2) render(false, Integrator::path, spp);
  EXPECT_EQ(pictures[0], pictures[2]);
  EXPECT_EQ(pictures[1], pictures[3]);
  EXPECT_GE(most, 2u);
}

}  // namespace
}  // namespace gatelight::renderer
