#pragma once
// Small scenes without light but what glows, and whether a person expects a soft sky beside it.

#include <algorithm>
#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/scene_builder.h"

namespace gatelight::tests {

/// Places things; y is up, in metres.
class GlowingSet : public testing::SceneBuilder {
 public:
  int matte(float grey) { return material(lambert(Color::Constant(grey))); }
  int glow(float radiance, const Color& color = Color::Ones(), float albedo = 0.0f) {
    return material(lambert(Color::Constant(albedo), color * radiance));
  }
  int sheet(float radiance) {
    scene::Material both = lambert(Color::Zero(), Color::Constant(radiance));
    both.double_sided = true;
    return material(both);
  }
  /// Glows at these of 8 x 8 texels.
  int pattern(float radiance, const std::vector<std::array<int, 2>>& lit, float albedo) {
    scene::Image image{.width = 8, .height = 8, .channels = 3, .pixels = std::vector<std::uint8_t>(192, 0)};
    for (const auto& [x, y] : lit) std::fill_n(image.pixels.begin() + 3 * (8 * y + x), 3, std::uint8_t{255});
    const int number = static_cast<int>(scene().images.size());
    scene().images.push_back(std::move(image));
    scene().textures.push_back({.image = number, .nearest = true});
    scene::Material m = lambert(Color::Constant(albedo), Color::Constant(radiance));
    m.emission_texture.texture = number;
    return material(m);
  }

  /// Faces up.
  void floor(int material, float half, float y = 0.0f) {
    quad(material, {-half, y, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
  }
  /// Faces +z.
  void wall(int material, const Vec3& middle, float width, float height) {
    const Vec3 corner = middle - Vec3(0.5f * width, 0.5f * height, 0);
    quad(material, corner, {width, 0, 0}, {0, height, 0}).uv0 = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  }
  /// Faces down.
  void lamp(int material, const Vec3& middle, float width, float depth) {
    quad(material, middle - Vec3(0.5f * width, 0, 0.5f * depth), {width, 0, 0}, {0, 0, depth});
  }
  void block(int material, const Vec3& foot, float width, float height, float depth) {
    box(material, foot - Vec3(0.5f * width, 0, 0.5f * depth),
        foot + Vec3(0.5f * width, height, 0.5f * depth));
  }
  void ball(int material, const Vec3& middle, float radius) { sphere(material, middle, radius, 24, true); }
  /// A closed one of 4 x 2.5 x 5 m, with a sofa.
  void room(float grey) {
    box(matte(grey), {-2, 0, -2.5f}, {2, 2.5f, 2.5f}, true);
    block(matte(0.4f), {0.3f, 0, -0.5f}, 1.6f, 0.5f, 0.8f);
  }
  void room_with_lamp(float radiance) {
    room(0.7f);
    lamp(glow(radiance), {0, 2.49f, 0}, 0.6f, 0.6f);
  }
  void cube_with_badge(float radiance) {
    box(matte(0.5f), {-1, -1, -1}, {1, 1, 1});
    wall(glow(radiance), {0.3f, 0.3f, 1.01f}, 0.5f, 0.3f);
  }
  void car(float headlights) {
    const int paint = matte(0.4f), tyre = matte(0.05f), light = glow(headlights);
    block(paint, {0, 0.3f, 0}, 1.8f, 0.5f, 4.2f);
    block(paint, {0, 0.8f, -0.3f}, 1.5f, 0.5f, 2.0f);
    for (const float x : {-0.8f, 0.8f}) {
      for (const float z : {-1.3f, 1.3f}) block(tyre, {x, 0, z}, 0.25f, 0.6f, 0.6f);
      wall(light, {0.8f * x, 0.6f, 2.11f}, 0.3f, 0.15f);
    }
  }
};

struct GlowingScene {
  std::string name;
  bool sky;  ///< a person expects the soft sky
  Vec3 eye, target;
  std::function<void(GlowingSet&)> build;
};

namespace glowing {

using Rows = std::vector<GlowingScene>;

inline void add_rooms(Rows& rows) {
  const auto add = [&](const char* name, const std::function<void(GlowingSet&)>& build) {
    rows.push_back({name, false, {0, 1.6f, 2.3f}, {0, 0.8f, -2.5f}, build});
  };
  add("lamp in a room", [](GlowingSet& s) { s.room_with_lamp(12); });
  add("lamp of huge strength", [](GlowingSet& s) { s.room_with_lamp(1e6f); });
  add("lamp of tiny strength", [](GlowingSet& s) { s.room_with_lamp(1e-4f); });
  add("emissive ceiling", [](GlowingSet& s) {
    s.room(0.5f);
    s.lamp(s.glow(0.8f), {0, 2.49f, 0}, 4, 5);
  });
  add("bulb", [](GlowingSet& s) {
    s.room(0.5f);
    s.ball(s.glow(300), {0, 2, 0}, 0.04f);
  });
  add("lamp above a shade", [](GlowingSet& s) {
    s.room(0.6f);
    s.lamp(s.matte(0.6f), {0, 2, 0}, 1, 1);
    s.floor(s.glow(20), 0.4f, 2.05f);
  });
  add("screen in a dark room", [](GlowingSet& s) {
    s.room(0.25f);
    s.wall(s.glow(1, {0.7f, 0.8f, 1}), {0, 1.2f, -2.48f}, 1.2f, 0.7f);
  });
  add("screen in a black room", [](GlowingSet& s) {
    s.room(0);
    s.wall(s.glow(1), {0, 1.2f, -2.48f}, 1.2f, 0.7f);
  });
  add("cinema", [](GlowingSet& s) {
    s.room(0.1f);
    s.wall(s.glow(1), {0, 1.4f, -2.48f}, 3, 1.6f);
    for (const float z : {0.3f, 1.0f, 1.6f}) s.block(s.matte(0.1f), {0, 0, z}, 3, 0.8f, 0.3f);
  });
  add("candle on a table", [](GlowingSet& s) {
    s.room(0.4f);
    s.block(s.matte(0.4f), {0, 0, 1}, 1.2f, 0.75f, 0.8f);
    s.block(s.matte(0.8f), {0, 0.75f, 1}, 0.05f, 0.15f, 0.05f);
    s.ball(s.glow(200, {1, 0.6f, 0.2f}), {0, 0.93f, 1}, 0.012f);
  });
}

inline void add_nights(Rows& rows) {
  rows.push_back({"monitor on a desk", false, {0.2f, 1.5f, 1.2f}, {0, 0.9f, 0}, [](GlowingSet& s) {
                    s.block(s.matte(0.5f), {0, 0, 0}, 1.4f, 0.75f, 0.7f);
                    s.block(s.matte(0.1f), {0, 0.85f, -0.25f}, 0.64f, 0.38f, 0.04f);
                    s.wall(s.glow(1.5f), {0, 1.04f, -0.228f}, 0.6f, 0.34f);
                    s.block(s.matte(0.2f), {0, 0.75f, 0.1f}, 0.45f, 0.03f, 0.15f);
                  }});
  rows.push_back({"neon sign", false, {0.8f, 1.6f, 5}, {0, 1.8f, 0}, [](GlowingSet& s) {
                    s.wall(s.matte(0.3f), {0, 2, 0}, 8, 4);
                    s.floor(s.matte(0.2f), 4);
                    const int red = s.glow(15, {1, 0.1f, 0.4f});
                    for (const float x : {-1.0f, -0.4f, 0.2f, 0.8f})
                      s.block(red, {x, 1.8f, 0.1f}, 0.05f, 0.8f, 0.05f);
                    s.block(s.glow(15, {0.1f, 0.4f, 1}), {0, 1.6f, 0.1f}, 2.4f, 0.05f, 0.05f);
                  }});
  rows.push_back({"camp fire", false, {1.5f, 1.6f, 4}, {0, 0.5f, 0}, [](GlowingSet& s) {
                    s.floor(s.matte(0.25f), 20);
                    s.ball(s.glow(25, {1, 0.5f, 0.15f}), {0, 0.25f, 0}, 0.22f);
                    for (const float x : {-1.2f, 1.4f})
                      s.block(s.matte(0.3f), {x, 0, -0.8f}, 0.9f, 0.4f, 0.4f);
                  }});
  rows.push_back({"street lamp", false, {4, 2, 9}, {0, 1.5f, 0}, [](GlowingSet& s) {
                    s.floor(s.matte(0.2f), 30);
                    s.block(s.matte(0.3f), {0, 0, 0}, 0.12f, 4.5f, 0.12f);
                    s.ball(s.glow(400), {0, 4.6f, 0}, 0.15f);
                    s.car(0);
                  }});
  rows.push_back({"paper lanterns", false, {0, 1.6f, 4}, {0, 1.2f, 0}, [](GlowingSet& s) {
                    s.floor(s.matte(0.4f), 5);
                    for (const float x : {-1.5f, 0.0f, 1.5f}) {
                      s.ball(s.glow(4, {1, 0.7f, 0.4f}), {x, 1.8f, -0.5f}, 0.25f);
                      s.ball(s.matte(0.5f), {x, 0.4f, 0}, 0.4f);
                    }
                  }});
  rows.push_back({"fireflies", false, {0, 1.6f, 5}, {0, 0.8f, 0}, [](GlowingSet& s) {
                    s.floor(s.matte(0.2f), 8);
                    s.ball(s.matte(0.3f), {-1, 0.8f, -1}, 0.8f);
                    const int fly = s.glow(5, {0.8f, 1, 0.3f});
                    for (int i = 0; i < 6; ++i) {
                      const Vec3 at(0.7f * static_cast<float>(i) - 1.5f,
                                    0.8f + 0.3f * static_cast<float>(i % 3), 0.5f);
                      s.quad(fly, at, {0.02f, 0, 0}, {0, 0.02f, 0});
                    }
                  }});
  rows.push_back({"house with lit windows", false, {6, 3, 10}, {0, 2, 0}, [](GlowingSet& s) {
                    s.floor(s.matte(0.3f), 12);
                    s.block(s.matte(0.5f), {0, 0, -2}, 6, 5, 4);
                    for (const float x : {-2.0f, 0.0f, 2.0f})
                      s.wall(s.glow(0.8f, {1, 0.8f, 0.5f}), {x, 3.5f, 0.01f}, 0.6f, 0.8f);
                  }});
}

inline void add_bright(Rows& rows) {
  rows.push_back({"open box with a lamp", false, {0, 1, 4.2f}, {0, 1, 0}, [](GlowingSet& s) {
                    s.floor(s.matte(0.7f), 1);
                    s.lamp(s.matte(0.7f), {0, 2, 0}, 2, 2);
                    s.lamp(s.glow(10), {0, 1.99f, 0}, 0.5f, 0.5f);
                    s.wall(s.matte(0.7f), {0, 1, -1}, 2, 2);
                    s.block(s.matte(0.7f), {0.3f, 0, 0}, 0.6f, 1.1f, 0.6f);
                  }});
  rows.push_back({"dome of a day", false, {0, 1.5f, 6}, {0, 1, 0}, [](GlowingSet& s) {
                    s.sphere(s.sheet(0.8f), {0, 0, 0}, 20, 24, false);
                    s.floor(s.matte(0.4f), 15);
                    s.ball(s.matte(0.5f), {0, 1, 0}, 1);
                  }});
  rows.push_back({"emissive back wall", false, {0, 1.5f, 6}, {0, 1.2f, 0}, [](GlowingSet& s) {
                    s.wall(s.glow(2), {0, 2, -3}, 8, 4);
                    s.floor(s.matte(0.5f), 4);
                    s.ball(s.matte(0.6f), {0, 1, 0}, 1);
                  }});
  rows.push_back({"light table", false, {0.3f, 1.2f, 2}, {0, 0.3f, 0}, [](GlowingSet& s) {
                    s.floor(s.glow(1), 1);
                    s.ball(s.matte(0.5f), {0, 0.35f, 0}, 0.35f);
                    s.ball(s.matte(0.2f), {0.6f, 0.2f, 0.2f}, 0.2f);
                  }});
  rows.push_back({"lava", false, {0, 3, 8}, {0, 0.5f, 0}, [](GlowingSet& s) {
                    s.floor(s.glow(3, {1, 0.3f, 0.05f}), 10);
                    for (const float x : {-3.0f, 0.0f, 2.5f}) s.ball(s.matte(0.15f), {x, 0.3f, x - 1}, 1);
                  }});
  rows.push_back({"double-sided sheet", false, {2.5f, 1.5f, 4}, {0, 0.8f, 0}, [](GlowingSet& s) {
                    s.floor(s.matte(0.5f), 3);
                    s.quad(s.sheet(3), {0, 0.1f, 1}, {0, 0, -2}, {0, 1.6f, 0});
                    for (const float x : {-1.0f, 1.0f}) s.ball(s.matte(0.5f), {x, 0.5f, 0}, 0.5f);
                  }});
  rows.push_back({"lamp hidden before a wall", false, {0, 1.5f, 5}, {0, 1.2f, 0}, [](GlowingSet& s) {
                    s.wall(s.matte(0.6f), {0, 2, -0.6f}, 6, 4);
                    s.floor(s.matte(0.5f), 3);
                    s.wall(s.matte(0.5f), {0, 1.5f, 0.1f}, 1.6f, 1.2f);
                    s.quad(s.glow(10), {0.7f, 1, 0}, {-1.4f, 0, 0}, {0, 1, 0});
                  }});
  rows.push_back({"scan with baked light", false, {2, 2, 4}, {0, 0.5f, 0}, [](GlowingSet& s) {
                    s.floor(s.glow(0.3f, {1, 0.9f, 0.8f}, 0.3f), 3);
                    s.ball(s.glow(0.5f, {0.6f, 0.4f, 0.3f}, 0.5f), {0, 0.7f, 0}, 0.7f);
                  }});
  rows.push_back({"lamp alone", false, {1, 1, 3}, {0, 0, 0}, [](GlowingSet& s) {
                    s.ball(s.glow(1, Color::Ones(), 0.5f), {0, 0, 0}, 1);
                  }});
}

inline void add_badges(Rows& rows) {
  const auto add = [&](const char* name, const std::function<void(GlowingSet&)>& build) {
    rows.push_back({name, true, {1.5f, 1.2f, 3.5f}, {0, 0, 0}, build});
  };
  add("badge on a cube", [](GlowingSet& s) { s.cube_with_badge(1); });
  add("badge of huge strength", [](GlowingSet& s) { s.cube_with_badge(1e4f); });
  add("badge of tiny strength", [](GlowingSet& s) { s.cube_with_badge(1e-4f); });
  add("badge above a lip", [](GlowingSet& s) {
    s.cube_with_badge(2);
    s.block(s.matte(0.5f), {0.3f, 0.05f, 1.06f}, 0.6f, 0.06f, 0.12f);
  });
  add("badges of a texture", [](GlowingSet& s) {
    s.ball(s.matte(0.3f), {0, 0, -0.3f}, 1);
    s.wall(s.pattern(1, {{1, 1}, {2, 1}, {5, 6}}, 0.5f), {0, 0, 0.75f}, 1.6f, 1.4f);
  });
  add("double-sided badge", [](GlowingSet& s) {
    s.ball(s.matte(0.5f), {0, 0, 0}, 1);
    s.wall(s.sheet(2), {0, 0.3f, 1.02f}, 0.4f, 0.2f);
  });
  add("sign with letters", [](GlowingSet& s) {
    s.block(s.matte(0.4f), {0, -0.6f, -0.1f}, 2.6f, 1.2f, 0.18f);
    for (const float x : {-0.8f, -0.3f, 0.2f, 0.7f}) s.wall(s.glow(1), {x, 0, 0}, 0.12f, 0.5f);
  });
  add("glow at the back", [](GlowingSet& s) {
    s.box(s.matte(0.5f), {-1, -1, -1}, {1, 1, 1});
    s.quad(s.glow(5), {0.5f, -0.5f, -1.01f}, {-1, 0, 0}, {0, 1, 0});
  });
  add("television", [](GlowingSet& s) {
    s.block(s.matte(0.1f), {0, -0.6f, -0.1f}, 2.2f, 1.3f, 0.18f);
    s.block(s.matte(0.1f), {0, -0.9f, -0.1f}, 1, 0.3f, 0.1f);
    s.wall(s.glow(1), {0, 0.05f, 0}, 2, 1.1f);
  });
}

inline void add_things(Rows& rows) {
  rows.push_back({"car with headlights", true, {4, 2, 6}, {0, 0.6f, 0}, [](GlowingSet& s) {
                    s.floor(s.matte(0.2f), 15);
                    s.car(5);
                  }});
  rows.push_back({"car without a road", true, {4, 2, 6}, {0, 0.6f, 0}, [](GlowingSet& s) { s.car(5); }});
  rows.push_back({"robot with eyes", true, {0.6f, 1.5f, 3}, {0, 0.9f, 0}, [](GlowingSet& s) {
                    s.floor(s.matte(0.5f), 3);
                    s.block(s.matte(0.5f), {0, 0.3f, 0}, 0.8f, 0.8f, 0.5f);
                    s.block(s.matte(0.5f), {0, 1.15f, 0}, 0.5f, 0.4f, 0.4f);
                    const int eye = s.glow(3, {0.2f, 0.9f, 1});
                    for (const float x : {-0.1f, 0.1f}) s.wall(eye, {x, 1.38f, 0.21f}, 0.08f, 0.08f);
                  }});
  rows.push_back({"telephone on a table", true, {0.2f, 1.2f, 0.6f}, {0, 0.75f, 0}, [](GlowingSet& s) {
                    s.block(s.matte(0.5f), {0, 0, 0}, 1, 0.75f, 0.8f);
                    s.block(s.matte(0.1f), {0, 0.75f, 0}, 0.16f, 0.01f, 0.08f);
                    s.floor(s.glow(1), 0.035f, 0.761f);
                  }});
  rows.push_back({"space ship", true, {3, 1.5f, 5}, {0, 0, 0}, [](GlowingSet& s) {
                    s.block(s.matte(0.4f), {0, -0.3f, 0}, 1, 0.6f, 4);
                    s.block(s.matte(0.4f), {0, -0.05f, -1}, 3.5f, 0.1f, 1);
                    s.quad(s.glow(20, {0.3f, 0.6f, 1}), {0.3f, -0.2f, -2.01f}, {-0.6f, 0, 0}, {0, 0.4f, 0});
                    for (const float z : {0.3f, 0.7f, 1.1f})
                      s.quad(s.glow(1), {0.51f, 0, z}, {0, 0, -0.2f}, {0, 0.1f, 0});
                  }});
  rows.push_back({"traffic light", true, {0.6f, 0.1f, 2}, {0, 0, 0}, [](GlowingSet& s) {
                    s.block(s.matte(0.1f), {0, -0.5f, 0}, 0.4f, 1, 0.3f);
                    s.ball(s.glow(2, {1, 0.1f, 0.05f}), {0, 0.3f, 0.12f}, 0.1f);
                    for (const float y : {0.0f, -0.3f}) s.ball(s.matte(0.1f), {0, y, 0.12f}, 0.1f);
                  }});
}

}  // namespace glowing

inline std::vector<GlowingScene> glowing_scenes() {
  std::vector<GlowingScene> rows;
  for (const auto add : {glowing::add_rooms, glowing::add_nights, glowing::add_bright, glowing::add_badges,
                         glowing::add_things})
    add(rows);
  return rows;
}

}  // namespace gatelight::tests
