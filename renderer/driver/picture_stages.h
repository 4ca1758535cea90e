#pragma once
// The stages around the passes of a picture. The whole team calls these functions.

#include <optional>

#include "renderer/driver/finished_picture.h"
#include "renderer/driver/frame_memory.h"
#include "renderer/driver/render_context.h"
#include "renderer/image/cryptomatte.h"

namespace gatelight::renderer {

/// The layers of RenderOptions::cryptomattes, where the picture is finished. Adds to `seconds`.
Cryptomattes make_cryptomattes(const RenderContext& context, double& seconds);

/// The finished picture of a film, with its view; empty where others finish it. Sets the denoiser's
/// statistics. `stopped`: the caller has stopped the samples, and not yet the denoiser. `memory`: of the
/// animation whose next frame may reuse the samples; null: none.
FinishedPicture finish(const RenderContext& context, Film& film, bool stopped, RenderStatistics& statistics,
                       FrameMemory* memory = nullptr);

/// Sets up what finish() needs, by one thread beside other work.
void prepare_to_finish(const PreparedPicture& picture);

/// The expected time of finish() under a time limit.
double expect_finish_seconds(const RenderContext& context);

/// The estimated error of the picture; empty where it is unknown.
std::optional<double> estimate_error(const RenderContext& context, Film& film);

}  // namespace gatelight::renderer
