#pragma once
// The choice of the next triangle to train (paper, section 3.2.1): rarely trained candidates are preferred.

#include <cstddef>
#include <cstdint>
#include <span>

namespace gatelight::neural {

/// The weight of a triangle that was trained `count` times: 1 / clamp(count, 1, 512). (The paper's 1/min(512,
/// t) is undefined for an untrained triangle.)
float training_weight(std::uint32_t count);

/// Returns the index into `candidates` that the uniform number u in [0,1) selects, with probability weight /
/// sum of weights. Candidates are triangle numbers (GateSurface::first_triangle + triangle), which index
/// `counts`. `counts` must not change while a batch is made, so that the choice does not depend on the order.
/// A candidate outside `counts` has weight 1.
std::size_t choose_candidate(std::span<const std::uint32_t> candidates, std::span<const std::uint32_t> counts,
                             float u);

}  // namespace gatelight::neural
