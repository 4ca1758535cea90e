#pragma once
// The error of one record is the sum over its outputs of (y - t)^2 / d.

#include <span>

#include "neural/model/training_options.h"

namespace gatelight::neural::reference {

/// 0.299, 0.587, 0.114 for three outputs, else the mean.
double luminance(std::span<const double> outputs);

/// d is 1, or luminance(y)^2 + 0.01, which the gradient treats as a constant (Mueller et al. 2021, section
/// 5).
double loss_denominator(Loss loss, std::span<const double> outputs);

double loss_value(std::span<const double> outputs, std::span<const double> targets, double denominator);

/// Writes scale 2 (y - t) / d. The scale is 1 / (records x outputs) for the mean over a batch.
void loss_gradient(std::span<const double> outputs, std::span<const double> targets, double denominator,
                   double scale, std::span<double> gradients);

}  // namespace gatelight::neural::reference
