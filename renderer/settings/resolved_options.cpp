#include "renderer/settings/resolved_options.h"

namespace gatelight::renderer {

float resolve_ao_distance(float option, const scene::Box& bounds) {
  if (option >= 0.0f) return option;
  return bounds.isEmpty() ? scene::kInfinity : 0.1f * bounds.diagonal().norm();
}

float resolve_filter_width(PixelFilter filter, float option) {
  if (option > 0.0f) return option;
  switch (filter) {
    case PixelFilter::box:
      return 1.0f;
    case PixelFilter::tent:
      return 2.0f;
    case PixelFilter::gaussian:
    case PixelFilter::blackman_harris:
      break;
  }
  return 3.0f;
}

}  // namespace gatelight::renderer
