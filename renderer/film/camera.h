#pragma once
// Generates primary rays.

#include <memory>
#include <optional>
#include <vector>

#include "renderer/image/picture.h"
#include "renderer/settings/view.h"
#include "renderer/surface/media.h"
#include "renderer/surface/ray.h"
#include "renderer/surface/surface.h"
#include "renderer/surface/surroundings.h"

namespace gatelight::renderer {

struct CameraRay {
  Ray ray;
  RayCone cone;
  float begin = 0.0f;  ///< metres from the eye to its origin: clipping leaves them out
};

class Camera {
 public:
  /// Takes the view and the size of the picture in pixels. The picture's aspect ratio replaces that of the
  /// camera; the vertical field of view stays.
  Camera(const View& view, int width, int height);

  /// Bounds of the points where rays start, for a filter of a few pixels.
  Box origins() const;
  /// Rays start in the media that are there; without this call in none. `surroundings`: for origins(). It is
  /// asked for each ray only if rays start in several places or at several times near a body.
  void set_surroundings(std::shared_ptr<const Surroundings> surroundings);
  /// The same as for another camera of the same view.
  void take_surroundings(const Camera& other);
  /// Whether some rays start in a body.
  bool is_in_media() const { return is_in_media_; }
  /// What a ray of this camera starts in.
  StartMedium medium_of(const Ray& ray) const {
    return surroundings_ ? surroundings_->at(ray.origin, ray.time) : medium_;
  }

  /// Rays get times from now on. `states`: of the camera, at evenly spaced times from the opening to the
  /// closing of the shutter, or empty where it stands still. `clock`: scene::ShutterMotion::clock.
  void open_shutter(std::vector<Camera> states, std::vector<float> clock);
  bool has_shutter() const { return has_shutter_; }

  bool has_lens() const { return lens_radius_ > 0.0f && focus_distance_ > 0.0f; }
  /// `x` and `y` are in pixels from the top left corner of the picture. `lens` in [0, 1)^2 is a point of the
  /// lens; that of a pinhole is ignored.
  CameraRay ray(float x, float y, const Vec2& lens) const;
  /// The same when a clock shows this in the open shutter, in [0, 1).
  CameraRay ray(float x, float y, const Vec2& lens, float seen) const;
  /// The ray through the middle of the lens, in the middle of the shutter.
  CameraRay ray(float x, float y) const;

  /// The place in the picture, in pixels from its top left corner, that shows a point of the world; nothing
  /// for one that is not before the camera. The inverse of ray(x, y).
  std::optional<Vec2> pixel_of(const Vec3& point) const;

  /// The unit direction of the ray through the middle of the lens to a point.
  Vec3 direction_to(const Vec3& point) const {
    return orthographic_ ? forward_ : (point - origin_).normalized();
  }

  /// The matrices for points in the file's coordinates, whose origin is at -`origin`. A panorama has none.
  std::optional<ViewMatrices> matrices(const Vec3& origin) const;

 private:
  CameraRay panorama_ray(float x, float y) const;
  /// The ray from the eye, clipped.
  CameraRay made(const Vec3& origin, const Vec3& direction) const;

  bool is_in_media_ = false;
  StartMedium medium_;  ///< of all rays, unless there are surroundings
  std::shared_ptr<const Surroundings> surroundings_;
  Vec3 origin_;
  Vec3 right_;  ///< one pixel, at a distance of one metre (perspective) or in the world (orthographic)
  Vec3 down_;
  Vec3 corner_;  ///< the top left corner of the picture: a direction (perspective) or a point (orthographic)
  Vec3 forward_;
  Vec3 unit_right_;
  Vec3 unit_up_;
  RayCone cone_;
  float near_;  ///< metres along the view; of a panorama along the ray
  float far_;
  float width_;  ///< pixels
  float height_;
  float lens_radius_;
  float focus_distance_;
  int blades_;
  bool orthographic_;
  bool panorama_;
  bool has_shutter_ = false;
  std::vector<Camera> states_;  ///< of the open shutter
  std::vector<float> clock_;
};

}  // namespace gatelight::renderer
