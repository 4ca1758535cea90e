#pragma once
// The limits of this machine, measured at run time on all threads that the process may use. They are the
// denominators of all fractions that the benchmarks print.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/simd/isa.h"

namespace gatelight::bench {

enum class Arithmetic : std::uint8_t {
  sse2,    ///< multiply and add of 4 floats, on any x86-64
  avx2,    ///< fused multiply-add of 8 floats
  avx512,  ///< fused multiply-add of 16 floats
  bf16,    ///< dot products of 32 bfloat16 into 16 floats (AVX512_BF16)
};

std::string_view arithmetic_name(Arithmetic arithmetic);
/// The arithmetics that the processor supports, slowest first.
std::vector<Arithmetic> available_arithmetics();
Arithmetic arithmetic_of(simd::Isa isa);

/// An amount of work and the seconds it took.
struct Work {
  double amount = 0.0;
  double seconds = 0.0;
  double rate() const { return amount / seconds; }
};

/// The amount is floating-point operations; a multiplication and an addition count two. Takes some
/// milliseconds.
Work run_fma(Arithmetic arithmetic);

/// Memory far larger than any cache, in huge pages where the system gives them. All pages are touched.
class BigBuffer {
 public:
  explicit BigBuffer(bool huge_pages = true);
  ~BigBuffer();
  BigBuffer(const BigBuffer&) = delete;
  BigBuffer& operator=(const BigBuffer&) = delete;
  static constexpr std::size_t kBytes = std::size_t{1} << 30;
  const std::uint64_t* words() const { return words_; }

 private:
  std::uint64_t* words_ = nullptr;
};

/// The amount is bytes, read in sequence.
Work run_stream(const BigBuffer& buffer);
/// The amount is reads of 64 aligned bytes at random places, prefetched 32 ahead.
Work run_gather(const BigBuffer& buffer);

/// The best of several runs, measured once in the process (a tenth of a second).
double fma_limit(Arithmetic arithmetic);  ///< operations per second
double gather_limit();                    ///< reads per second

}  // namespace gatelight::bench
