// Lamps that share their place with other surfaces.

#include "scene/coincident_emitters.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace gatelight::scene {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

constexpr Triangle kFront{0, 1, 2}, kTurned{2, 1, 0};

/// Makes meshes of the same three corners.
class Doubled {
 public:
  int lamp(bool double_sided = false) { return material(Color::Constant(5.0f), double_sided); }
  int wall(bool double_sided = false) { return material(Color::Zero(), double_sided); }

  void add(int material, std::vector<Triangle> triangles) {
    Mesh mesh;
    mesh.material = material;
    for (const Vec3& corner : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(5, 5, 5)})
      mesh.positions.push_back(corner);
    mesh.triangles = std::move(triangles);
    Instance instance;
    instance.mesh = static_cast<int>(scene_.meshes.size());
    instance.baked = true;
    scene_.meshes.push_back(std::move(mesh));
    scene_.instances.push_back(instance);
  }

  /// What a ray meets on the front and on the back of kFront: L or l for the front and the back of a lamp, W
  /// or w for a wall, none for nothing, and all where it may meet several.
  std::string seen() {
    separate_coincident_emitters(scene_);
    std::string front, back;
    for (const Instance& instance : scene_.instances) {
      const Material& m = scene_.material_of(instance);
      for (const Triangle& t : scene_.mesh_of(instance).triangles) {
        if (t[0] == 3 || t[1] == 3 || t[2] == 3) continue;
        const bool turned = t == kTurned || t == Triangle{1, 0, 2} || t == Triangle{0, 2, 1};
        const bool shines = m.double_sided;
        const auto show = [&](bool own_front) {
          const char letter = m.emits() ? 'L' : 'W';
          return own_front || shines ? letter : static_cast<char>(letter + 32);
        };
        if (!turned || !m.culled) front += show(!turned);
        if (turned || !m.culled) back += show(turned);
      }
    }
    return front + "/" + back;
  }

  Scene& scene() { return scene_; }

 private:
  int material(const Color& emission, bool double_sided) {
    Material m;
    m.emission = emission;
    m.double_sided = double_sided;
    scene_.materials.push_back(m);
    return static_cast<int>(scene_.materials.size()) - 1;
  }

  Scene scene_;
};

TEST(DoubledLamps, AreSeenFromTheirFronts) {
  {
    Doubled d;
    d.add(d.lamp(), {kFront, kTurned});
    EXPECT_EQ(d.seen(), "L/L") << "both sides of one mesh shine";
  }
  const auto seen_with = [](const Triangle& wall, bool lamp_first) {
    Doubled d;
    const int w = d.wall(), l = d.lamp();
    if (lamp_first) d.add(l, {kFront});
    d.add(w, {wall});
    if (!lamp_first) d.add(l, {kFront});
    return d.seen();
  };
  for (const bool lamp_first : {false, true}) {
    for (const Triangle& wall : {kTurned, Triangle{1, 0, 2}, Triangle{0, 2, 1}})
      EXPECT_EQ(seen_with(wall, lamp_first), "L/W") << "the wall has its back to the lamp";
    for (const Triangle& wall : {kFront, Triangle{1, 2, 0}})
      EXPECT_EQ(seen_with(wall, lamp_first), "L/l") << "both look the same way: the lamp stays";
  }
}

TEST(DoubledLamps, OfTwoSidesHideTheOther) {
  for (const Triangle& wall : {kFront, kTurned}) {
    for (const bool both : {false, true}) {
      Doubled d;
      d.add(d.wall(both), {wall});
      d.add(d.lamp(true), {kFront});
      EXPECT_EQ(d.seen(), "L/L");
      EXPECT_EQ(d.scene().meshes.size(), 1u) << "a mesh without triangles goes";
    }
  }
}

TEST(DoubledLamps, LeaveTheRestOfTheirMeshesAsItIs) {
  Doubled d;
  d.add(d.wall(), {{0, 1, 3}, kTurned, {1, 2, 3}});
  d.add(d.lamp(), {{0, 2, 3}, kFront});
  EXPECT_EQ(d.seen(), "L/W");
  std::size_t culled = 0, plain = 0;
  for (const Instance& i : d.scene().instances)
    (d.scene().material_of(i).culled ? culled : plain) += d.scene().mesh_of(i).triangles.size();
  EXPECT_EQ(culled, 2u);
  EXPECT_EQ(plain, 3u);
}

TEST(DoubledLamps, OtherSurfacesStay) {
  Doubled walls;
  walls.add(walls.wall(), {kFront});
  walls.add(walls.wall(), {kTurned});
  EXPECT_EQ(walls.seen(), "Ww/wW") << "none emits";
  Doubled clear;
  clear.add(clear.wall(), {kTurned});
  clear.add(clear.lamp(), {kFront});
  clear.scene().materials.back().alpha_mode = AlphaMode::blend;
  EXPECT_EQ(clear.seen(), "wL/Wl") << "the wall shows through the label";
}

TEST(DoubledLamps, AreFoundInSharedMeshesAndMirroredInstances) {
  Doubled d;
  d.add(d.lamp(), {kFront, kTurned});
  d.scene().instances[0].baked = false;
  d.scene().instances.push_back(d.scene().instances[0]);
  d.scene().instances[1].transform.translation() = Vec3(9, 0, 0);
  separate_coincident_emitters(d.scene());
  EXPECT_TRUE(d.scene().material_of(d.scene().instances[0]).culled);
  EXPECT_TRUE(d.scene().material_of(d.scene().instances[1]).culled);

  Doubled mirrored;
  mirrored.add(mirrored.wall(), {kTurned});
  mirrored.add(mirrored.lamp(), {kFront});
  Instance& instance = mirrored.scene().instances[0];
  instance.baked = false;
  instance.swaps_handedness = true;
  // Exchanges x and y: the corners stay in place, and the front stays in front.
  instance.transform.linear() << 0, 1, 0, 1, 0, 0, 0, 0, 1;
  separate_coincident_emitters(mirrored.scene());
  EXPECT_EQ(mirrored.scene().instances.size(), 2u);
  for (const Instance& i : mirrored.scene().instances) EXPECT_TRUE(mirrored.scene().material_of(i).culled);
}

}  // namespace
}  // namespace gatelight::scene
