#include "renderer/reuse/visible_points.h"

#include <array>
#include <cmath>

#include "base/parallel/loops.h"
#include "renderer/film/tiles.h"
#include "renderer/transport/guide_surface.h"

namespace gatelight::renderer {
namespace {

/// Mirrors and panes that are followed.
constexpr int kMostPassed = 8;

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

/// How much of the light depends on the view, roughly: that of metals, coats and smooth dielectrics.
void set_gloss(const SurfaceMaterial& m, VisiblePoint& point) {
  constexpr float kSmooth = 0.4f, kOfLobe = 0.7f;
  const bool coated = m.clearcoat > 0.1f;
  const float roughness = coated ? std::min(m.roughness, m.clearcoat_roughness) : m.roughness;
  const float dielectric = coated || roughness < kSmooth ? 1.0f : 0.0f;
  point.glossy = std::max({m.metallic, m.transmission, dielectric});
  point.lobe = std::max(kOfLobe * roughness * roughness, 0.01f);
}

/// The walk of one pixel's ray.
struct Walker {
  std::size_t pixel;
  Ray ray;
  RayCone cone;
  float travelled = 0.0f;
  Affine image = Affine::Identity();  ///< from a point to its image in the mirrors, a frame ago
  bool had_image = true;
};

class Tracer {
 public:
  Tracer(const World& world, const EarlierView* earlier, VisiblePoints& points)
      : world_(world), earlier_(earlier), points_(points) {}

  /// Returns whether the ray goes on.
  bool arrive(Walker& walker, const Hit& hit) {
    if (!hit) {
      if (earlier_ && walker.had_image) note_background(walker);
      return false;
    }
    const Vec3 direction = walker.ray.direction;
    walker.travelled += hit.t;
    const float width = walker.cone.width + walker.cone.spread * walker.travelled;
    const Surface surface = world_.surfaces.at(hit, direction, width, 0.5f);
    const SurfaceMaterial& m = surface.material;
    if (is_mirror_or_clear(m))
      return m.transmission > 0.5f ? pass(walker, hit, surface) : reflect(walker, hit, surface);
    const std::optional<Plane> plane =
        plane_of(scene::world_triangle(world_.scene, instance(hit), hit.primitive), hit);
    if (!plane) return false;
    VisiblePoint& point = points_.now[walker.pixel];
    const bool turned = plane->normal.dot(direction) > 0.0f;
    const Vec3 normal = turned ? Vec3(-plane->normal) : plane->normal;
    point = {hit, plane->point, normal, width, mirrored(direction, normal)};
    set_gloss(m, point);
    if (earlier_ && walker.had_image) note_earlier(walker, hit, turned);
    return false;
  }

 private:
  const scene::Instance& instance(const Hit& hit) const { return world_.scene.instances[hit.instance]; }

  static bool pass(Walker& walker, const Hit&, const Surface& surface) {
    if (!surface.material.thin_walled) return false;
    walker.ray.origin = surface.spawn(walker.ray.direction);
    return true;
  }

  bool reflect(Walker& walker, const Hit& hit, const Surface& surface) {
    const Vec3 n = surface.shading_normal, d = walker.ray.direction;
    const Vec3 out = (d - 2.0f * n.dot(d) * n).normalized();
    if (!(out.dot(surface.geometric_normal) > 0.0f)) return false;
    if (earlier_ && walker.had_image) {
      const auto corners = earlier_->moment.triangle(world_.scene, hit.instance, hit.primitive);
      const auto plane = corners ? plane_of(*corners, hit) : std::nullopt;
      walker.had_image = plane.has_value();
      if (plane) walker.image = walker.image * reflection(plane->point, plane->normal);
    }
    walker.ray.origin = surface.spawn(out);
    walker.ray.direction = out;
    return true;
  }

  /// The background is infinitely far away.
  void note_background(const Walker& walker) {
    constexpr float kFar = 1e7f;
    const std::optional<Vec2> pixel =
        earlier_->camera.pixel_of(walker.image * Vec3(walker.ray.origin + kFar * walker.ray.direction));
    if (pixel) points_.earlier[walker.pixel] = EarlierPoint{.pixel = *pixel};
  }

  void note_earlier(const Walker& walker, const Hit& hit, bool turned) {
    const auto corners = earlier_->moment.triangle(world_.scene, hit.instance, hit.primitive);
    const auto plane = corners ? plane_of(*corners, hit) : std::nullopt;
    if (!plane) return;
    const std::optional<Vec2> pixel = earlier_->camera.pixel_of(walker.image * plane->point);
    if (!pixel) return;
    const Vec3 normal = turned ? Vec3(-plane->normal) : plane->normal;
    // The way of the ray behind the mirrors.
    const Vec3 seen = earlier_->camera.direction_to(walker.image * plane->point);
    const Vec3 direction = walker.image.linear().transpose() * seen;
    points_.earlier[walker.pixel] = EarlierPoint{*pixel, plane->point, normal, mirrored(direction, normal)};
  }

  const World& world_;
  const EarlierView* earlier_;
  VisiblePoints& points_;
};

}  // namespace

VisiblePoints trace_visible_points(const World& world, const Camera& camera, const PixelRect& rect,
                                   const EarlierView* earlier) {
  VisiblePoints points;
  const auto pixels = static_cast<std::size_t>(rect.width()) * static_cast<std::size_t>(rect.height());
  points.now.resize(pixels);
  if (earlier) points.earlier.resize(pixels);
  Tracer tracer(world, earlier, points);
  const TileGrid tiles(rect);
  for_each(static_cast<std::size_t>(tiles.count()), [&](std::size_t tile) {
    std::vector<Pixel> of_tile;
    tiles.pixels(static_cast<int>(tile), of_tile);
    std::vector<Walker> walkers;
    for (const Pixel& p : of_tile) {
      const CameraRay from = camera.ray(static_cast<float>(p.x) + 0.5f, static_cast<float>(p.y) + 0.5f);
      walkers.push_back({.pixel = rect.index(p.x, p.y), .ray = from.ray, .cone = from.cone});
    }
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    for (int passed = 0; !walkers.empty() && passed <= kMostPassed; ++passed) {
      rays.clear();
      for (const Walker& walker : walkers) rays.push_back(walker.ray);
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
