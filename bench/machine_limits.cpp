#include "bench/machine_limits.h"

#if !defined(__x86_64__) || !defined(__linux__)
#error "the limits of another machine would be measured otherwise: configure with -DGATELIGHT_BENCHMARKS=OFF"
#endif

#include <immintrin.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <map>
#include <new>
#include <thread>

#include "base/platform/threads.h"

namespace gatelight::bench {

namespace {

// There are enough chains of dependent operations for two units with a latency of 4 to 6, and few enough for
// the registers. Initialisation, loop and sum are all unrolled, because an array that is indexed stays in
// memory.
constexpr int kChains = 12;      // of 16 registers
constexpr int kWideChains = 24;  // of 32

float burn_sse2(std::int64_t steps) {
  const __m128 factor = _mm_set1_ps(0.999f), summand = _mm_set1_ps(0.001f);
  __m128 chains[kChains];
#pragma GCC unroll 12
  for (int i = 0; i < kChains; ++i) chains[i] = _mm_set1_ps(static_cast<float>(i));
  for (std::int64_t step = 0; step < steps; ++step) {
#pragma GCC unroll 12
    for (int i = 0; i < kChains; ++i) chains[i] = _mm_add_ps(_mm_mul_ps(chains[i], factor), summand);
  }
  __m128 sum = chains[0];
#pragma GCC unroll 12
  for (int i = 1; i < kChains; ++i) sum = _mm_add_ps(sum, chains[i]);
  return _mm_cvtss_f32(sum);
}

__attribute__((target("avx2,fma"))) float burn_avx2(std::int64_t steps) {
  const __m256 factor = _mm256_set1_ps(0.999f), summand = _mm256_set1_ps(0.001f);
  __m256 chains[kChains];
#pragma GCC unroll 12
  for (int i = 0; i < kChains; ++i) chains[i] = _mm256_set1_ps(static_cast<float>(i));
  for (std::int64_t step = 0; step < steps; ++step) {
#pragma GCC unroll 12
    for (int i = 0; i < kChains; ++i) chains[i] = _mm256_fmadd_ps(chains[i], factor, summand);
  }
  __m256 sum = chains[0];
#pragma GCC unroll 12
  for (int i = 1; i < kChains; ++i) sum = _mm256_add_ps(sum, chains[i]);
  return _mm256_cvtss_f32(sum);
}

__attribute__((target("avx512f"))) float burn_avx512(std::int64_t steps) {
  const __m512 factor = _mm512_set1_ps(0.999f), summand = _mm512_set1_ps(0.001f);
  __m512 chains[kWideChains];
#pragma GCC unroll 24
  for (int i = 0; i < kWideChains; ++i) chains[i] = _mm512_set1_ps(static_cast<float>(i));
  for (std::int64_t step = 0; step < steps; ++step) {
#pragma GCC unroll 24
    for (int i = 0; i < kWideChains; ++i) chains[i] = _mm512_fmadd_ps(chains[i], factor, summand);
  }
  __m512 sum = chains[0];
#pragma GCC unroll 24
  for (int i = 1; i < kWideChains; ++i) sum = _mm512_add_ps(sum, chains[i]);
  return _mm512_cvtss_f32(sum);
}

__attribute__((target("avx512f,avx512bf16"))) float burn_bf16(std::int64_t steps) {
  const __m512bh factor = _mm512_cvtne2ps_pbh(_mm512_set1_ps(0.5f), _mm512_set1_ps(0.5f));
  const __m512bh other = _mm512_cvtne2ps_pbh(_mm512_set1_ps(1e-3f), _mm512_set1_ps(-1e-3f));
  __m512 chains[kWideChains];
#pragma GCC unroll 24
  for (int i = 0; i < kWideChains; ++i) chains[i] = _mm512_set1_ps(static_cast<float>(i));
  for (std::int64_t step = 0; step < steps; ++step) {
#pragma GCC unroll 24
    for (int i = 0; i < kWideChains; ++i) chains[i] = _mm512_dpbf16_ps(chains[i], factor, other);
  }
  __m512 sum = chains[0];
#pragma GCC unroll 24
  for (int i = 1; i < kWideChains; ++i) sum = _mm512_add_ps(sum, chains[i]);
  return _mm512_cvtss_f32(sum);
}

struct Burner {
  std::string_view name;
  bool is_available;
  float (*burn)(std::int64_t);
  double operations;  ///< per step
};

/// One entry for each Arithmetic, in its order.
const std::array<Burner, 4>& burners() {
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  const bool avx512 = __builtin_cpu_supports("avx512f");
  const bool bf16 = avx512 && __builtin_cpu_supports("avx512bf16");
  static const std::array<Burner, 4> all = {{{"sse2", true, burn_sse2, 8.0 * kChains},
                                             {"avx2", avx2, burn_avx2, 16.0 * kChains},
                                             {"avx512", avx512, burn_avx512, 32.0 * kWideChains},
                                             {"bf16", bf16, burn_bf16, 64.0 * kWideChains}}};
  return all;
}

/// Results go here, so that the compiler removes no loop.
std::atomic<std::uint64_t> sink{0};

/// Runs body(thread) on all threads at once, including the calling one. Returns the seconds from the common
/// start to the last end.
template <class Body>
double seconds_of(int threads, Body&& body) {
  using Clock = std::chrono::steady_clock;
  std::atomic<int> waiting{threads - 1};
  std::atomic<bool> go{false};
  std::vector<std::thread> others;
  for (int thread = 1; thread < threads; ++thread) {
    others.emplace_back([&, thread] {
      waiting.fetch_sub(1);
      while (!go.load(std::memory_order_acquire)) {
      }
      body(thread);
    });
  }
  while (waiting.load() > 0) {
  }
  const Clock::time_point start = Clock::now();
  go.store(true, std::memory_order_release);
  body(0);
  for (std::thread& thread : others) thread.join();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::uint64_t sum_words(const std::uint64_t* words, std::size_t count) {
  std::uint64_t sums[16] = {};
  for (std::size_t i = 0; i < count; i += 16) {
    for (std::size_t k = 0; k < 16; ++k) sums[k] += words[i + k];
  }
  std::uint64_t sum = 0;
  for (const std::uint64_t s : sums) sum += s;
  return sum;
}

/// Knuth's linear congruential generator. Its upper bits are random enough for caches and prefetchers.
std::uint64_t next_random(std::uint64_t& state) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return state;
}

std::uint64_t gather_lines(const std::uint64_t* words, std::size_t reads, std::uint64_t seed) {
  constexpr std::size_t kLineWords = 8;
  constexpr int kShift = 64 - 24;  // 2^24 lines of 64 bytes
  static_assert(BigBuffer::kBytes == (std::size_t{1} << 24) * kLineWords * sizeof(std::uint64_t));
  std::uint64_t now = seed, ahead = seed;
  for (int i = 0; i < 32; ++i) next_random(ahead);
  std::uint64_t sums[kLineWords] = {};
  for (std::size_t i = 0; i < reads; ++i) {
    __builtin_prefetch(words + kLineWords * (next_random(ahead) >> kShift));
    const std::uint64_t* line = words + kLineWords * (next_random(now) >> kShift);
    for (std::size_t k = 0; k < kLineWords; ++k) sums[k] += line[k];
  }
  std::uint64_t sum = 0;
  for (const std::uint64_t s : sums) sum += s;
  return sum;
}

template <class Run>
double best_rate(int runs, Run&& run) {
  double best = 0.0;
  for (int i = 0; i < runs; ++i) best = std::max(best, run().rate());
  return best;
}

}  // namespace

std::string_view arithmetic_name(Arithmetic arithmetic) {
  return burners()[static_cast<std::size_t>(arithmetic)].name;
}

std::vector<Arithmetic> available_arithmetics() {
  std::vector<Arithmetic> available;
  for (std::size_t i = 0; i < burners().size(); ++i) {
    if (burners()[i].is_available) available.push_back(static_cast<Arithmetic>(i));
  }
  return available;
}

Arithmetic arithmetic_of(simd::Isa isa) {
  switch (isa) {
    case simd::Isa::scalar:
      return Arithmetic::sse2;
    case simd::Isa::avx2:
      return Arithmetic::avx2;
    case simd::Isa::avx512:
      return Arithmetic::avx512;
  }
  return Arithmetic::sse2;
}

Work run_fma(Arithmetic arithmetic) {
  const Burner& burner = burners()[static_cast<std::size_t>(arithmetic)];
  constexpr std::int64_t kSteps = 500'000;
  const int threads = available_threads();
  const double seconds = seconds_of(
      threads, [&](int) { sink.fetch_add(static_cast<std::uint64_t>(burner.burn(kSteps) > 0.0f)); });
  return {burner.operations * static_cast<double>(kSteps) * threads, seconds};
}

BigBuffer::BigBuffer(bool huge_pages) {
  constexpr std::size_t kHugePage = std::size_t{2} << 20;
  words_ = static_cast<std::uint64_t*>(::operator new (kBytes, std::align_val_t{kHugePage}));
  // Where the system refuses huge pages, the reads are slower and the limit is lower.
  ::madvise(words_, kBytes, huge_pages ? MADV_HUGEPAGE : MADV_NOHUGEPAGE);
  const int threads = available_threads();
  const std::size_t count = kBytes / sizeof(std::uint64_t);
  seconds_of(threads, [&](int thread) {
    const std::size_t begin = count * static_cast<std::size_t>(thread) / static_cast<std::size_t>(threads);
    const std::size_t end = count * static_cast<std::size_t>(thread + 1) / static_cast<std::size_t>(threads);
    std::fill(words_ + begin, words_ + end, 1);
  });
}

BigBuffer::~BigBuffer() {
  ::operator delete (words_, std::align_val_t{std::size_t{2} << 20});
}

Work run_stream(const BigBuffer& buffer) {
  // Each pass reads an eighth of the buffer, so that it returns to the same bytes after a gigabyte.
  constexpr std::size_t kPassWords = BigBuffer::kBytes / sizeof(std::uint64_t) / 8;
  static std::atomic<std::size_t> passes{0};
  const int threads = available_threads();
  const std::uint64_t* first = buffer.words() + kPassWords * (passes.fetch_add(1) % 8);
  const std::size_t count = kPassWords / static_cast<std::size_t>(threads) / 16 * 16;
  const double seconds = seconds_of(threads, [&](int thread) {
    sink.fetch_add(sum_words(first + count * static_cast<std::size_t>(thread), count));
  });
  return {static_cast<double>(count * sizeof(std::uint64_t)) * threads, seconds};
}

Work run_gather(const BigBuffer& buffer) {
  constexpr std::size_t kReads = 250'000;
  // Each pass reads other places, because those of the last pass may still be in a cache.
  static std::atomic<std::uint64_t> seeds{0};
  const int threads = available_threads();
  const double seconds = seconds_of(threads, [&](int) {
    sink.fetch_add(gather_lines(buffer.words(), kReads, 0x9e3779b97f4a7c15u * (1 + seeds.fetch_add(1))));
  });
  return {static_cast<double>(kReads) * threads, seconds};
}

double fma_limit(Arithmetic arithmetic) {
  static std::map<Arithmetic, double> limits;
  const auto found = limits.find(arithmetic);
  if (found != limits.end()) return found->second;
  return limits[arithmetic] = best_rate(30, [&] { return run_fma(arithmetic); });
}

double gather_limit() {
  static const double limit = [] {
    const BigBuffer buffer;
    return best_rate(30, [&] { return run_gather(buffer); });
  }();
  return limit;
}

}  // namespace gatelight::bench
