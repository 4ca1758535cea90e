#pragma once
// How far the material of a surface is another one than a frame ago.

#include "renderer/surface/surface.h"

namespace gatelight::renderer {

/// The part of a surface's light that depends on the view, roughly: that of metals, coats and smooth
/// dielectrics.
struct Gloss {
  float share = 0.0f;  ///< of the light
  float lobe = 1.0f;   ///< radians: the width of that part
};
Gloss gloss_of(const SurfaceMaterial& m);

/// The relative change of the light that the surface sends to the viewer, roughly: 0 for the same material,
/// at most 1. Both are the same place of the same triangle.
float surface_change(const Surface& now, const Surface& earlier);

/// What the material's inside lets through, along its thickness; white for what has none.
Color light_through(const scene::Material& m);

/// The change of that.
float inside_change(const scene::Material& now, const scene::Material& earlier);

}  // namespace gatelight::renderer
