#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {

float resolve_ao_distance(float option, const scene::Box& bounds) {
  if (option >= 0.0f) return option;
  return bounds.isEmpty() ? scene::kInfinity : 0.1f * bounds.diagonal().norm();
}

float resolve_filter_width(PixelFilter filter, float option) {
  if (option > 0.0f) return option;
  if (filter == PixelFilter::box) return 1.0f;
  return filter == PixelFilter::tent ? 2.0f : 3.0f;
}

}  // namespace gatelight::renderer
