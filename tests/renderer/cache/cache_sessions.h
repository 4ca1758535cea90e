#pragma once
// Sessions that train a small cache, and their answers.

#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "renderer/cache/cache_session.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {

/// Options of a session that learns a closed box in a hundred steps.
inline RenderOptions small_session(Integrator integrator) {
  RenderOptions options;
  options.integrator = integrator;
  options.max_depth = 32;
  options.cache.batch = 2048;
  options.cache.node_spacing = 0.7f;
  return options;
}

/// The points that the camera sees, as points to query.
inline SurfacePoints seen_points(const testing::ViewedWorld& viewed, const CacheSession& session) {
  SurfacePoints points(session.inputs());
  for (int y = 1; y < viewed.region.height(); y += 3) {
    for (int x = 1; x < viewed.region.width(); x += 3) {
      const CameraRay ray = viewed.camera.ray(static_cast<float>(x), static_cast<float>(y));
      Hit hit;
      viewed.world.accel.intersect(std::span(&ray.ray, 1), std::span(&hit, 1), true);
      if (!hit) continue;
      const Surface surface = viewed.world.surfaces.at(hit, ray.ray.direction, 0.0f, 0.5f);
      points.push_back(surface_point(
          hit, side_of(surface.front, viewed.world.scene.instances[hit.instance].swaps_handedness),
          -ray.ray.direction, surface, surface.material.base_color));
    }
  }
  return points;
}

inline std::vector<float> answers_of(CacheSession& session, const SurfacePoints& points) {
  std::vector<float> answers(session.outputs() * points.size());
  session.answer(points, answers);
  return answers;
}

/// Mean of all answers at the points that the camera sees.
inline double mean_answer(CacheSession& session, const testing::ViewedWorld& viewed) {
  testing::Moments moments;
  for (const float a : answers_of(session, seen_points(viewed, session))) moments.add(static_cast<double>(a));
  EXPECT_GT(moments.count(), 300u);
  return moments.mean();
}

}  // namespace gatelight::renderer
