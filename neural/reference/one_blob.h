#pragma once
// One-blob encoding (Mueller et al. 2019) with the quartic kernel of tiny-cuda-nn: each of k bins holds the
// integral of a bump around x, of half width 1/k, over the bin.

#include <span>

namespace gatelight::neural::reference {

/// Integral from minus infinity to u of 15/16 (1 - u^2)^2 over [-1,1].
double quartic_cdf(double u);

/// bins[b] = cdf(b+1 - kx) - cdf(b - kx) for the k = bins.size() bins of [0,1]. If x wraps, the part of the
/// bump beyond 0 or 1 re-enters at the other end and the sum of the bins is one; else that part is lost.
void one_blob(double x, bool wraps, std::span<double> bins);

}  // namespace gatelight::neural::reference
