#pragma once
// The picture of a film, as the options ask for it.

#include <tbb/task_arena.h>

#include "renderer/film/film.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

/// The means of the samples, or with options.reconstruct the finished picture, with the output variables of
/// the options. The film keeps those of film_aovs(options). seconds: receives the time of reconstruction.
Picture finished_picture(const Film& film, const RenderOptions& options, tbb::task_arena& arena,
                         double& seconds);

}  // namespace gatelight::renderer
