#pragma once
// Which triangle to train next (paper, section 3.2.1): candidates are chosen by how seldom they were trained.

#include <cstddef>
#include <cstdint>
#include <span>

namespace gatelight::neural {

/// The weight of a triangle that was trained `count` times: 1 / clamp(count, 1, 512). (The paper's 1/min(512,
/// t) has no value for an untrained triangle.)
float training_weight(std::uint32_t count);

/// The index into `candidates` that a uniform number u in [0,1) picks, with probability weight / sum of
/// weights. `candidates` are triangle numbers (GateSurface::first_triangle + triangle) into `counts`, a
/// snapshot that nobody changes while a batch is made: so the choice depends on no order. A candidate outside
/// `counts` has weight 1.
std::size_t choose_candidate(std::span<const std::uint32_t> candidates, std::span<const std::uint32_t> counts,
                             float u);

}  // namespace gatelight::neural
