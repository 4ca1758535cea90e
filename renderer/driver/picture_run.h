#pragma once

#include "renderer/driver/render_context.h"

namespace gatelight::renderer {

/// Renderer::render(). `statistics` are those of the picture so far whenever a callback is called.
Picture render_picture(const RenderContext& context, RenderStatistics& statistics);

}  // namespace gatelight::renderer
