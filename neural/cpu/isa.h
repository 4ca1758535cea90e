#pragma once
// Which instruction set the kernels use.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace gatelight::neural::cpu {

enum class Isa : std::uint8_t { scalar, avx2, avx512 };

std::string_view isa_name(Isa isa);
/// "scalar", "avx2" or "avx512"; nothing for any other word.
std::optional<Isa> parse_isa(std::string_view name);

/// What this processor and operating system can run, slowest first. avx2 needs FMA and F16C; avx512 needs F,
/// DQ, BW and VL.
std::vector<Isa> available_isas();

/// The fastest, unless one is forced: by the argument, or else by the environment variable GATELIGHT_ISA.
/// Throws Unavailable, with the list of those that are there, when the forced one is missing or unknown.
/// An empty variable forces nothing.
Isa select_isa(std::optional<Isa> forced = std::nullopt);
/// The same choice among `available`, slowest first, with the variable's value given.
Isa choose_isa(std::optional<Isa> forced, std::string_view environment, std::span<const Isa> available);

}  // namespace gatelight::neural::cpu
