#pragma once
// What the middle of each pixel shows, behind mirrors and clear panes, and where it was a frame ago.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderer/film/camera.h"
#include "renderer/image/pixel_rect.h"
#include "renderer/temporal/scene_snapshot.h"
#include "renderer/transport/world.h"

namespace gatelight::renderer {

struct VisiblePoint {
  Hit hit;  ///< of the surface; without one the pixel shows the sky, or what no reuse can follow
  std::uint32_t layers = 0;  ///< the same for the same surfaces before it: mirrors, panes, and blended ones
  Vec3 position = Vec3::Zero();   ///< world
  Vec3 normal = Vec3::Zero();     ///< unit, of the triangle, on the side of the viewer
  float width = 0.0f;             ///< of a pixel there, metres
  Vec3 reflected = Vec3::Zero();  ///< unit: the mirror direction of the view
  float glossy = 0.0f;            ///< share of the light that comes from around it
  float lobe = 1.0f;              ///< radians: the width of that part
};

/// The point of the same surface at an earlier time. Of the background only the pixel is known.
struct EarlierPoint {
  Vec2 pixel = Vec2::Zero();      ///< its place in the earlier picture, in pixels from the top left corner
  Vec3 position = Vec3::Zero();   ///< world
  Vec3 normal = Vec3::Zero();     ///< unit
  Vec3 reflected = Vec3::Zero();  ///< unit
};

/// An earlier time and its view.
struct PreviousView {
  SceneSnapshot moment;
  Camera camera;
};

struct VisiblePoints {
  std::vector<VisiblePoint> now;                     ///< by pixel, in rows from the top
  std::vector<std::optional<EarlierPoint>> earlier;  ///< empty without an earlier view
  /// 1 float a pixel: how far what it shows is of another material than at the earlier time
  /// (surface_change.h), with what lies before that point, and what it mirrors. Empty where materials do not
  /// change.
  std::vector<float> changes;
};

/// Follows mirrors by the law of reflection, with the image behind a mirror where its plane was, and passes
/// thin panes. Rays that refract are not followed. `earlier`: null for none. Works in the caller's arena.
VisiblePoints trace_visible_points(const World& world, const Camera& camera, const PixelRect& rect,
                                   const PreviousView* earlier);

}  // namespace gatelight::renderer
