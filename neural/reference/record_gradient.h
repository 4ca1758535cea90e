#pragma once
// Forward and backward pass for one record.

#include <span>
#include <vector>

#include "neural/model/training_options.h"
#include "neural/reference/point.h"

namespace gatelight::neural::reference {

/// The network's linear outputs.
std::vector<double> evaluate(const Model& model, std::span<const double> parameters, const Point& point);

/// Adds scale times the derivative of the record's error to `gradients`, which has the layout of the
/// parameters. Returns the error, summed over the outputs.
double add_record_gradient(const Model& model, Loss loss, std::span<const double> parameters,
                           const Point& point, std::span<const double> targets, double scale,
                           std::span<double> gradients);

}  // namespace gatelight::neural::reference
