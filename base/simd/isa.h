#pragma once
// The choice of the kernels' instruction set.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace gatelight::simd {

enum class Isa : std::uint8_t { scalar, avx2, avx512 };

std::string_view isa_name(Isa isa);
/// Accepts "scalar", "avx2" and "avx512"; nullopt for any other name.
std::optional<Isa> parse_isa(std::string_view name);

/// The instruction sets that this processor and operating system support, slowest first. avx2 includes FMA
/// and F16C; avx512 includes F, DQ, BW and VL.
std::vector<Isa> available_isas();

/// Returns `forced`, else the value of the environment variable GATELIGHT_ISA, else the fastest instruction
/// set. An empty variable counts as unset. Throws Unavailable, which lists the available ones, if the chosen
/// one is missing or unknown.
Isa select_isa(std::optional<Isa> forced = std::nullopt);
/// The same choice among `available` (slowest first), with the value of the variable given.
Isa choose_isa(std::optional<Isa> forced, std::string_view environment, std::span<const Isa> available);

}  // namespace gatelight::simd
