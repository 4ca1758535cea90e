#pragma once

#include <span>

#include "renderer/metrics/flip.h"

namespace gatelight::renderer::flip {

/// Not empty, all in [0, 1].
FlipSummary summarize(std::span<const float> errors);

}  // namespace gatelight::renderer::flip
