#include "renderer/film/camera.h"

#include <algorithm>
#include <cmath>

#include "renderer/sampling/warp.h"
#include "scene/shutter.h"

namespace gatelight::renderer {
namespace {

/// Uniform on a regular polygon with corners on the unit circle, one of them at the top.
Vec2 polygon_point(const Vec2& u, int corners) {
  const auto count = static_cast<float>(corners);
  const float scaled = std::min(u.x() * count, std::nextafter(count, 0.0f));
  const float side = std::floor(scaled);
  const auto corner = [&](float k) {
    const float angle = 0.5f * kPi + 2.0f * kPi * k / count;
    return Vec2(std::cos(angle), std::sin(angle));
  };
  // Uniform in the triangle of the middle and two corners.
  const float root = std::sqrt(scaled - side);
  return root * ((1.0f - u.y()) * corner(side) + u.y() * corner(side + 1.0f));
}

}  // namespace

Camera::Camera(const View& view, int width, int height)
    : near_(view.clip.near),
      far_(view.clip.far),
      width_(static_cast<float>(width)),
      height_(static_cast<float>(height)),
      lens_radius_(view.lens_radius),
      focus_distance_(view.focus_distance),
      blades_(view.blades),
      orthographic_(view.orthographic),
      panorama_(view.panorama) {
  const Eigen::Matrix3f frame = view.transform.linear();
  origin_ = view.transform.translation();
  forward_ = -frame.col(2).normalized();
  unit_right_ = frame.col(0).normalized();
  unit_up_ = frame.col(1).normalized();
  const float aspect = width_ / height_;
  const float half_height = orthographic_ ? view.half_height : std::tan(0.5f * view.vertical_fov);
  const float half_width = half_height * aspect;
  right_ = unit_right_ * (2.0f * half_width / width_);
  down_ = unit_up_ * (-2.0f * half_height / height_);
  corner_ = unit_up_ * half_height - unit_right_ * half_width;
  const float pixel = 2.0f * half_height / height_;
  if (panorama_) {
    cone_ = {0.0f, kPi / height_};
  } else if (orthographic_) {
    corner_ += origin_;
    cone_ = {pixel, 0.0f};
  } else {
    corner_ += forward_;
    cone_ = {0.0f, pixel};
  }
}

Box Camera::origins() const {
  Box box;
  if (panorama_) {
    const Vec3 reach = Vec3::Constant(near_);
    box = Box(origin_ - reach, origin_ + reach);
  } else if (orthographic_ || near_ > 0.0f) {
    const float margin = 16.0f + 0.05f * std::max(width_, height_);  // pixels, for the filter
    for (const float x : {-margin, width_ + margin}) {
      for (const float y : {-margin, height_ + margin}) box.extend(ray(x, y).ray.origin);
    }
  } else {
    box.extend(origin_);
  }
  if (has_lens()) {
    const Vec3 reach = lens_radius_ * (unit_right_.cwiseAbs() + unit_up_.cwiseAbs());
    box = Box(box.min() - reach, box.max() + reach);
  }
  for (const Camera& state : states_) box.extend(state.origins());
  return box;
}

void Camera::set_surroundings(std::shared_ptr<const Surroundings> surroundings) {
  medium_ = {};
  surroundings_ = nullptr;
  is_in_media_ = !surroundings->empty();
  if (surroundings->empty()) return;
  const Box places = origins();
  if (has_shutter_ || places.min() != places.max()) {
    surroundings_ = std::move(surroundings);
  } else {
    medium_ = surroundings->at(places.min(), scene::kShutterMiddle);
  }
}

void Camera::take_surroundings(const Camera& other) {
  is_in_media_ = other.is_in_media_;
  medium_ = other.medium_;
  surroundings_ = other.surroundings_;
}

CameraRay Camera::panorama_ray(float x, float y) const {
  // The filter may reach beyond the poles.
  const float azimuth = (x / width_ - 0.5f) * 2.0f * kPi, polar = y / height_ * kPi;
  const float level = std::sin(polar);
  return made(origin_, (level * std::sin(azimuth) * unit_right_ + std::cos(polar) * unit_up_ +
                        level * std::cos(azimuth) * forward_)
                           .normalized());
}

CameraRay Camera::made(const Vec3& origin, const Vec3& direction) const {
  CameraRay result;
  result.ray.origin = origin;
  result.ray.direction = direction;
  result.ray.mask = ray_mask(scene::kCameraRays);
  result.cone = cone_;
  if (!(near_ > 0.0f) && !(far_ < kInfinity)) return result;
  const float stretch = panorama_ ? 1.0f : 1.0f / direction.dot(forward_);
  result.begin = near_ * stretch;
  result.ray.origin += result.begin * direction;
  result.ray.t_max = (far_ - near_) * stretch;
  result.cone.width += cone_.spread * result.begin;
  return result;
}

CameraRay Camera::ray(float x, float y) const {
  if (panorama_) return panorama_ray(x, y);
  const Vec3 on_plane = corner_ + right_ * x + down_ * y;
  return orthographic_ ? made(on_plane, forward_) : made(origin_, on_plane.normalized());
}

CameraRay Camera::ray(float x, float y, const Vec2& lens) const {
  if (!has_lens()) return ray(x, y);
  const Vec2 p = lens_radius_ * (blades_ > 0 ? polygon_point(lens, blades_) : sample_concentric_disk(lens));
  const Vec3 offset = p.x() * unit_right_ + p.y() * unit_up_;
  return made(origin_ + offset, ((corner_ + right_ * x + down_ * y) * focus_distance_ - offset).normalized());
}

void Camera::open_shutter(std::vector<Camera> states, std::vector<float> clock) {
  has_shutter_ = true;
  states_ = std::move(states);
  clock_ = std::move(clock);
}

CameraRay Camera::ray(float x, float y, const Vec2& lens, float seen) const {
  const float time = scene::time_by_clock(clock_, seen);
  CameraRay result;
  if (states_.empty()) {
    result = ray(x, y, lens);
  } else {
    const auto around = scene::states_around(states_, time);
    const CameraRay a = around.before.ray(x, y, lens), b = around.after.ray(x, y, lens);
    result = a;
    result.ray.origin = scene::between(a.ray.origin, b.ray.origin, around.fraction);
    result.ray.direction = scene::between(a.ray.direction, b.ray.direction, around.fraction).normalized();
    result.begin = scene::between(a.begin, b.begin, around.fraction);
  }
  result.ray.time = time;
  return result;
}

std::optional<Vec2> Camera::pixel_of(const Vec3& point) const {
  const Vec3 to = point - origin_;
  const float ahead = to.dot(forward_);
  const float x = to.dot(unit_right_), y = to.dot(unit_up_);
  if (panorama_) {
    if (!(to.squaredNorm() > 0.0f)) return std::nullopt;
    const float polar = std::acos(std::clamp(y / to.norm(), -1.0f, 1.0f));
    return Vec2((std::atan2(x, ahead) / (2.0f * kPi) + 0.5f) * width_, polar / kPi * height_);
  }
  const float scale = orthographic_ ? 1.0f : ahead;
  if (!(scale > 0.0f)) return std::nullopt;
  return Vec2(0.5f * width_ + x / (scale * right_.norm()), 0.5f * height_ - y / (scale * down_.norm()));
}

std::optional<ViewMatrices> Camera::matrices(const Vec3& origin) const {
  if (panorama_) return std::nullopt;
  Eigen::Matrix4d to_camera = Eigen::Matrix4d::Identity();
  const Eigen::Vector3d rows[] = {unit_right_.cast<double>(), unit_up_.cast<double>(),
                                  forward_.cast<double>()};
  const Eigen::Vector3d eye = (origin_ + origin).cast<double>();
  for (int i = 0; i < 3; ++i) {
    to_camera.block<1, 3>(i, 0) = rows[i].transpose();
    to_camera(i, 3) = -rows[i].dot(eye);
  }
  // x and y from the middle to an edge, at a distance of one metre or in the world.
  const auto half_width = static_cast<double>(0.5f * width_ * right_.norm());
  const auto half_height = static_cast<double>(0.5f * height_ * down_.norm());
  Eigen::Matrix4d to_ndc = Eigen::Matrix4d::Identity();
  to_ndc(0, 0) = 0.5 / half_width;
  to_ndc(1, 1) = -0.5 / half_height;
  if (orthographic_) {
    to_ndc(0, 3) = to_ndc(1, 3) = 0.5;
  } else {
    to_ndc(0, 2) = to_ndc(1, 2) = 0.5;
    to_ndc(3, 2) = 1.0;
    to_ndc(3, 3) = 0.0;
  }
  ViewMatrices result;
  Eigen::Map<Eigen::Matrix4f>(result.world_to_camera.data()) = to_camera.cast<float>();
  Eigen::Map<Eigen::Matrix4f>(result.world_to_ndc.data()) = (to_ndc * to_camera).cast<float>();
  return result;
}

}  // namespace gatelight::renderer
