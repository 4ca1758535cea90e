#include "base/simd/isa.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "base/errors.h"

namespace gatelight::simd {

namespace {

constexpr const char* kVariable = "GATELIGHT_ISA";
constexpr std::array<Isa, 3> kIsas = {Isa::scalar, Isa::avx2, Isa::avx512};

// __builtin_cpu_supports also checks that the operating system saves the registers.
bool has_avx2() {
#if defined(__x86_64__)
  const bool vectors = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#if defined(__clang__)
  return vectors;  // clang does not know the name f16c; every processor with AVX2 has it
#else
  return vectors && __builtin_cpu_supports("f16c");
#endif
#else
  return false;
#endif
}

bool has_avx512() {
#if defined(__x86_64__)
  return has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
         __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
#else
  return false;
#endif
}

std::string list(std::span<const Isa> isas) {
  std::vector<std::string_view> names;
  for (const Isa isa : isas) names.push_back(isa_name(isa));
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string_view isa_name(Isa isa) {
  constexpr std::array<std::string_view, kIsas.size()> kNames = {"scalar", "avx2", "avx512"};
  return kNames[static_cast<std::size_t>(isa)];
}

std::optional<Isa> parse_isa(std::string_view name) {
  for (const Isa isa : kIsas) {
    if (name == isa_name(isa)) return isa;
  }
  return std::nullopt;
}

std::vector<Isa> available_isas() {
  std::vector<Isa> isas = {Isa::scalar};
  if (has_avx2()) isas.push_back(Isa::avx2);
  if (has_avx512()) isas.push_back(Isa::avx512);
  return isas;
}

Isa choose_isa(std::optional<Isa> forced, std::string_view environment, std::span<const Isa> available) {
  std::string source = "the requested instruction set";
  if (!forced && !environment.empty()) {
    source = kVariable;
    forced = parse_isa(environment);
    if (!forced)
      throw Unavailable(fmt::format("{}: '{}', expected one of {}", kVariable, environment, list(available)));
  }
  if (!forced) return available.back();
  if (std::find(available.begin(), available.end(), *forced) == available.end())
    throw Unavailable(fmt::format("{}: {} is not on this machine, which has {}", source, isa_name(*forced),
                                  list(available)));
  return *forced;
}

Isa select_isa(std::optional<Isa> forced) {
  const char* environment = std::getenv(kVariable);
  return choose_isa(forced, environment != nullptr ? environment : "", available_isas());
}

}  // namespace gatelight::simd
