#include "renderer/temporal/visible_points.h"

#include <array>
#include <cmath>

#include "base/parallel/loops.h"
#include "renderer/film/tiles.h"
#include "renderer/temporal/surface_change.h"
#include "renderer/transport/guide_surface.h"

namespace gatelight::renderer {
namespace {

/// Mirrors and panes that are followed.
constexpr int kMaxPasses = 8;
/// The same with blended surfaces, where anything moves.
constexpr int kMaxMet = 32;
/// What has less weight in a pixel's light is not looked for.
constexpr float kMinWeight = 0.01f;

Affine reflection(const Vec3& point, const Vec3& normal) {
  Affine mirror = Affine::Identity();
  mirror.linear() -= 2.0f * normal * normal.transpose();
  mirror.translation() = 2.0f * normal.dot(point) * normal;
  return mirror;
}

struct Plane {
  Vec3 point;
  Vec3 normal;
};

/// The place and the unit normal of a point of a triangle; nothing where that has no area.
std::optional<Plane> plane_of(const std::array<Vec3, 3>& corners, const Hit& hit) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).stableNormalized();
  if (!(normal.squaredNorm() > 0.5f)) return std::nullopt;
  return Plane{(1.0f - hit.u - hit.v) * corners[0] + hit.u * corners[1] + hit.v * corners[2], normal};
}

Vec3 mirrored(const Vec3& direction, const Vec3& normal) {
  return direction - 2.0f * normal.dot(direction) * normal;
}

/// The walk of one pixel's ray.
struct PixelPath {
  std::size_t pixel;
  Ray ray;
  RayCone cone;
  float travelled = 0.0f;
  Affine image = Affine::Identity();  ///< from a point to its image in the mirrors, a frame ago
  bool had_image = true;
  std::uint32_t seed = 0;  ///< decides which blended surface the point is on
  float weight = 1.0f;     ///< in the pixel's light, of what the ray meets from here on
  std::uint32_t layers = 0;
  bool arrived = false;  ///< the point is found; what follows is behind it, or mirrored by it
};

class Tracer {
 public:
  Tracer(const World& world, const PreviousView* earlier, VisiblePoints& points)
      : world_(world), earlier_(earlier), points_(points) {
    finds_changes_ = earlier && earlier->moment.has_materials();
    meets_all_ = world.scene.motion.any();
    if (finds_changes_) points.changes.resize(points.now.size());
  }

  int most_passed() const { return meets_all_ ? kMaxMet : kMaxPasses; }

  PixelPath start(std::size_t pixel, const CameraRay& from) const {
    PixelPath path{.pixel = pixel, .ray = from.ray, .cone = from.cone, .seed = from.ray.seed};
    if (meets_all_) path.ray.seed = kMeetsAll;
    return path;
  }

  /// Returns whether the ray goes on.
  bool arrive(PixelPath& path, const Hit& hit) {
    if (!hit) {
      if (earlier_ && path.had_image && !path.arrived) note_background(path);
      return false;
    }
    const Vec3 direction = path.ray.direction;
    path.travelled += hit.t;
    const float width = path.cone.width + path.cone.spread * path.travelled;
    const Surface surface = world_.surfaces.at(hit, direction, width, 0.5f);
    const SurfaceMaterial& m = surface.material;
    const float alpha = alpha_of(hit, world_.surfaces.material(hit.instance));
    if (finds_changes_) note_change(path, hit, surface, width, alpha);
    if (alpha < 1.0f && (path.arrived || !world_.coverage.is_there(hit, path.seed)))
      return go_behind(path, hit, surface, alpha);
    if (is_mirror_or_clear(m))
      return m.transmission > 0.5f ? pass(path, hit, surface) : reflect(path, hit, surface);
    if (path.arrived || !note_point(path, hit, surface, width) || !finds_changes_) return false;
    path.arrived = true;
    return alpha < 1.0f ? go_behind(path, hit, surface, alpha) : look_at_reflection(path, surface, width);
  }

 private:
  const scene::Instance& instance(const Hit& hit) const { return world_.scene.instances[hit.instance]; }

  float alpha_of(const Hit& hit, const scene::Material& m) const {
    if (!meets_all_ || m.alpha_mode != scene::AlphaMode::blend) return 1.0f;
    return std::clamp(world_.coverage.alpha(hit, m), 0.0f, 1.0f);
  }

  /// Adds the change of the surface since the earlier time.
  void note_change(const PixelPath& path, const Hit& hit, const Surface& surface, float width, float alpha) {
    const scene::Material& now = world_.surfaces.material(hit.instance);
    const scene::Material& before = earlier_->moment.material(world_.scene, hit.instance);
    const Surface earlier = world_.surfaces.at(hit, path.ray.direction, width, 0.5f, before);
    points_.changes[path.pixel] +=
        path.weight * (std::abs(alpha_of(hit, before) - alpha) +
                       alpha * (surface_change(surface, earlier) + inside_change(now, before)));
  }

  static void note_layer(PixelPath& path, const Hit& hit) {
    path.layers = hash(path.layers ^ hash(hit.instance + 1));
  }

  /// Goes on behind a blended surface.
  static bool go_behind(PixelPath& path, const Hit& hit, const Surface& surface, float alpha) {
    path.ray.origin = surface.spawn(path.ray.direction);
    path.weight *= 1.0f - alpha;
    if (!path.arrived && alpha > kMinWeight) note_layer(path, hit);
    return !path.arrived || path.weight > kMinWeight;
  }

  /// Goes on to what the surface of the point mirrors.
  static bool look_at_reflection(PixelPath& path, const Surface& surface, float width) {
    const Gloss gloss = gloss_of(surface.material);
    const Vec3 out = mirrored(path.ray.direction, surface.shading_normal).normalized();
    if (!(out.dot(surface.geometric_normal) > 0.0f)) return false;
    path.ray.origin = surface.spawn(out);
    path.ray.direction = out;
    path.cone = {width, path.cone.spread + gloss.lobe};
    path.travelled = 0.0f;
    path.weight *= gloss.share;
    return path.weight > kMinWeight;
  }

  /// Stores the point; false where its triangle has no area.
  bool note_point(const PixelPath& path, const Hit& hit, const Surface& surface, float width) {
    const std::optional<Plane> plane =
        plane_of(scene::world_triangle(world_.scene, instance(hit), hit.primitive), hit);
    if (!plane) return false;
    const Vec3& direction = path.ray.direction;
    const bool turned = plane->normal.dot(direction) > 0.0f;
    const Vec3 normal = turned ? Vec3(-plane->normal) : plane->normal;
    const Gloss gloss = gloss_of(surface.material);
    points_.now[path.pixel] = {.hit = hit,
                               .layers = path.layers,
                               .position = plane->point,
                               .normal = normal,
                               .width = width,
                               .reflected = mirrored(direction, normal),
                               .glossy = gloss.share,
                               .lobe = gloss.lobe};
    if (earlier_ && path.had_image) note_earlier(path, hit, turned);
    return true;
  }

  static bool pass(PixelPath& path, const Hit& hit, const Surface& surface) {
    if (!surface.material.thin_walled) return false;
    note_layer(path, hit);
    path.ray.origin = surface.spawn(path.ray.direction);
    return true;
  }

  bool reflect(PixelPath& path, const Hit& hit, const Surface& surface) {
    const Vec3 n = surface.shading_normal, d = path.ray.direction;
    const Vec3 out = (d - 2.0f * n.dot(d) * n).normalized();
    if (!(out.dot(surface.geometric_normal) > 0.0f)) return false;
    if (earlier_ && path.had_image && !path.arrived) {
      const auto corners = earlier_->moment.triangle(world_.scene, hit.instance, hit.primitive);
      const auto plane = corners ? plane_of(*corners, hit) : std::nullopt;
      path.had_image = plane.has_value();
      if (plane) path.image = path.image * reflection(plane->point, plane->normal);
    }
    note_layer(path, hit);
    path.ray.origin = surface.spawn(out);
    path.ray.direction = out;
    return true;
  }

  /// The background is infinitely far away.
  void note_background(const PixelPath& path) {
    constexpr float kFar = 1e7f;
    const std::optional<Vec2> pixel =
        earlier_->camera.pixel_of(path.image * Vec3(path.ray.origin + kFar * path.ray.direction));
    if (pixel) points_.earlier[path.pixel] = EarlierPoint{.pixel = *pixel};
  }

  void note_earlier(const PixelPath& path, const Hit& hit, bool turned) {
    const auto corners = earlier_->moment.triangle(world_.scene, hit.instance, hit.primitive);
    const auto plane = corners ? plane_of(*corners, hit) : std::nullopt;
    if (!plane) return;
    const std::optional<Vec2> pixel = earlier_->camera.pixel_of(path.image * plane->point);
    if (!pixel) return;
    const Vec3 normal = turned ? Vec3(-plane->normal) : plane->normal;
    // The way of the ray behind the mirrors.
    const Vec3 seen = earlier_->camera.direction_to(path.image * plane->point);
    const Vec3 direction = path.image.linear().transpose() * seen;
    points_.earlier[path.pixel] = EarlierPoint{*pixel, plane->point, normal, mirrored(direction, normal)};
  }

  const World& world_;
  const PreviousView* earlier_;
  VisiblePoints& points_;
  bool finds_changes_ = false;
  bool meets_all_ = false;  ///< also blended surfaces that the point is behind
};

}  // namespace

VisiblePoints trace_visible_points(const World& world, const Camera& camera, const PixelRect& rect,
                                   const PreviousView* earlier) {
  VisiblePoints points;
  const auto pixels = static_cast<std::size_t>(rect.width()) * static_cast<std::size_t>(rect.height());
  points.now.resize(pixels);
  if (earlier) points.earlier.resize(pixels);
  Tracer tracer(world, earlier, points);
  const TileGrid tiles(rect);
  for_each(static_cast<std::size_t>(tiles.count()), [&](std::size_t tile) {
    std::vector<Pixel> of_tile;
    tiles.pixels(static_cast<int>(tile), of_tile);
    std::vector<PixelPath> walkers;
    for (const Pixel& p : of_tile) {
      const CameraRay from = camera.ray(static_cast<float>(p.x) + 0.5f, static_cast<float>(p.y) + 0.5f);
      walkers.push_back(tracer.start(rect.index(p.x, p.y), from));
    }
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    for (int passed = 0; !walkers.empty() && passed <= tracer.most_passed(); ++passed) {
      rays.clear();
      for (const PixelPath& path : walkers) rays.push_back(path.ray);
      hits.assign(rays.size(), {});
      world.accel.intersect(rays, hits, passed == 0);
      std::size_t left = 0;
      for (std::size_t i = 0; i < walkers.size(); ++i) {
        if (tracer.arrive(walkers[i], hits[i])) walkers[left++] = walkers[i];
      }
      walkers.resize(left);
    }
  });
  return points;
}

}  // namespace gatelight::renderer
