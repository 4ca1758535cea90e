#pragma once

#include "renderer/driver/render_context.h"

namespace gatelight::renderer {

/// Renderer::render_series(). `statistics` are those of the last picture.
bool render_series(const RenderContext& context, const Series& series, const SeriesPicture& picture,
                   RenderStatistics& statistics);

}  // namespace gatelight::renderer
