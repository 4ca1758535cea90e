#pragma once
// The thin film of a material at a point.

#include "renderer/bsdf/bsdf.h"
#include "renderer/surface/texture.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// Reads the film into `result`. `read` looks up a slot that has a texture, with an Encoding.
template <class Read>
void read_film(const scene::Material& m, const Read& read, SurfaceMaterial& result) {
  if (!(m.iridescence > 0.0f)) return;
  result.iridescence = m.iridescence;
  if (m.iridescence_texture) result.iridescence *= read(m.iridescence_texture, Encoding::linear).x();
  result.film_ior = m.film_ior;
  result.film_thickness = m.film_thickness_maximum;
  if (!m.film_thickness_texture) return;
  const float share = read(m.film_thickness_texture, Encoding::linear).y();
  result.film_thickness =
      m.film_thickness_minimum + share * (m.film_thickness_maximum - m.film_thickness_minimum);
}

}  // namespace gatelight::renderer
