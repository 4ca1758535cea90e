#pragma once
// The error that a picture is expected to have, from the standard errors of its pixels.

#include "renderer/image/picture.h"

namespace gatelight::renderer {

/// Estimates the square root of rel_mse (compare.h): the root of the mean over pixels and channels of squared
/// standard error / (squared value + 1e-2). `errors` has the standard errors of the channels of `values`. A
/// value is the mean over the `smoothing` pixels around it in each direction, because it is noisy itself: the
/// error of a bright sample over the square of that same sample would be almost 0.
double estimated_error(const Picture& picture, const Layer& values, const Layer& errors, int smoothing);

}  // namespace gatelight::renderer
