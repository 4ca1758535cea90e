#pragma once
// How long reconstruction takes on this machine.

#include <tbb/task_arena.h>

#include "renderer/image/pixel_rect.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

/// The expected seconds of finished_picture() for a picture of this size: a narrow one of noise is
/// reconstructed and timed.
double expect_reconstruct_seconds(const PixelRect& region, const RenderOptions& options,
                                  tbb::task_arena& arena);

}  // namespace gatelight::renderer
