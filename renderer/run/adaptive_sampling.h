#pragma once
// Samples where they are needed: after some passes the finished picture tells where the next ones go.

#include "renderer/film/film.h"
#include "renderer/film/sample_density.h"
#include "renderer/reconstruction/reconstruct.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

/// The first number of samples per pixel above `samples` at which the density is made anew: 2, 8, 32 and so
/// on. It depends on nothing else, so that a picture is the same for any number of threads, in a series of
/// pictures, and where it is resumed. Never, if the options do not ask for it.
int next_density(const RenderOptions& options, int samples);

/// The density that suits a finished picture: in proportion to the noise that is left, relative to
/// brightness. Each half gets its samples by the noise of the other one, so that how many it gets does not
/// depend on what they were (Kirk and Arvo 1991).
SampleDensity make_density(const PixelRect& rect, const Reconstruction& finished);

/// Whether the film should follow the density of its finished picture from now on: before a pass, where
/// `samples` per pixel are one of these numbers.
bool density_due(const Film& film, int samples, const RenderOptions& options);

}  // namespace gatelight::renderer
