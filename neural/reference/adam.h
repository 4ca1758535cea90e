#pragma once
// Adam (Kingma, Ba 2015, algorithm 1).

#include <cstdint>

#include "neural/model/training_options.h"

namespace gatelight::neural::reference {

struct Moments {
  double first = 0;   ///< m
  double second = 0;  ///< v
};

/// Updates the moments with the gradient and returns the parameter after step t >= 1.
double adam(const AdamOptions& options, std::uint64_t t, double parameter, double gradient, Moments& moments);

}  // namespace gatelight::neural::reference
