#pragma once

#include "renderer/driver/frame_memory.h"
#include "renderer/driver/render_context.h"

namespace gatelight::renderer {

/// Renderer::render(). `statistics` are those of the picture so far whenever a callback is called.
/// `memory`: of the animation that the picture is a frame of; null for a still.
Picture render_picture(const RenderContext& context, RenderStatistics& statistics,
                       FrameMemory* memory = nullptr);

}  // namespace gatelight::renderer
