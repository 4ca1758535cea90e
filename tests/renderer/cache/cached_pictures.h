#pragma once
// Small pictures with a cache, and checks of them.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "renderer/cache/cache_session.h"
#include "renderer/cache/cached_pass.h"
#include "renderer/image/picture.h"
#include "renderer/settings/options.h"
#include "tests/renderer/cache/small_worlds.h"
#include "tests/support/materials.h"
#include "tests/support/picture_moments.h"

namespace gatelight::renderer {

/// Options of a picture that trains a cache in a fraction of a second.
inline RenderOptions cached_picture(Integrator integrator) {
  RenderOptions options;
  options.integrator = integrator;
  options.width = 64;
  options.height = 48;
  options.spp = 4;
  options.max_depth = 32;
  options.cache.train_steps = 60;
  options.cache.batch = 2048;
  options.cache.node_spacing = 0.7f;
  options.cache.self_training.start_step = 20;
  return options;
}

/// A floor, a back wall and a mirror, lit by a sun through the open front.
inline testing::SceneBuilder walls_and_mirror() {
  testing::SceneBuilder builder;
  const int wall = builder.material(testing::SceneBuilder::lambert(Color(0.7f, 0.6f, 0.5f)));
  builder.quad(wall, Vec3(-2, 0, 2), Vec3(4, 0, 0), Vec3(0, 0, -4));
  builder.quad(wall, Vec3(-2, 0, -2), Vec3(4, 0, 0), Vec3(0, 3, 0));
  builder.quad(builder.material(testing::mirror()), Vec3(0.2f, 0.2f, -1.9f), Vec3(1.5f, 0, 0), Vec3(0, 2, 0));
  builder.scene().lights = {testing::sun(Vec3(-0.3f, -0.6f, -0.5f), Color(1.0f, 0.9f, 0.7f))};
  builder.scene().cameras.push_back(testing::view_from(Vec3(0.4f, 1.3f, 4), Vec3(0, 1, 0)));
  return builder;
}

inline const std::vector<float>& pixels(const Picture& picture) {
  return picture.layers[0].values;
}

inline void expect_sound(const Picture& picture) {
  for (const Layer& layer : picture.layers) {
    for (const float v : layer.values) ASSERT_TRUE(std::isfinite(v)) << layer.name;
  }
  for (const float v : pixels(picture)) ASSERT_GE(v, 0.0f);
}

/// One pass over a region with a trained session.
inline Picture pass_over(const testing::ViewedWorld& viewed, const RenderOptions& options,
                         CacheSession& session, const PixelRect& region,
                         CacheStatistics* statistics = nullptr) {
  const TileGrid tiles(region);
  const FilterSampler filter(options.filter, options.filter_width);
  const PassContext context{tiles, options, viewed.camera, filter};
  Film film(region, viewed.region.width(), viewed.region.height(), film_contents(options));
  CachedPass pass(viewed.world, context, session);
  pass.run(options.spp, film, [](double) {});
  if (statistics) pass.add_to(*statistics);
  return film.resolve();
}

}  // namespace gatelight::renderer
