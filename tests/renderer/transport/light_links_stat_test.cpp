// Lights that light only some objects, and in whose light only some cast shadows: closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "tests/support/light_scenes.h"
#include "tests/support/messages.h"
#include "tests/support/sheltered_floor.h"
#include "tests/support/statistics.h"

namespace gatelight::renderer {
namespace {

using testing::Moments;
using testing::ShelteredFloor;

// Of the means of this file.
const double kLinksSignificance = testing::sidak(1e-4, 50);

enum class LinkedLamp { point, spot, sun, quad, environment };
constexpr LinkedLamp kLinkedLamps[] = {LinkedLamp::point, LinkedLamp::spot, LinkedLamp::sun, LinkedLamp::quad,
                                       LinkedLamp::environment};
constexpr std::size_t kWallsNumber = 0, kFloorNumber = 1;

/// A floor without walls, seen from below all lamps.
struct LitFloor : ShelteredFloor {
  LitFloor() : ShelteredFloor(matte()) {
    hide_walls(scene::kAllRays);
    options.environment = {};
    options.camera.look_at->eye = Vec3(0, 0.9f, 0);
    options.spp = 128;
  }

  /// Adds a lamp and returns its link. Of all but the environment, add objects before.
  scene::LightLink& add(LinkedLamp lamp) {
    if (lamp == LinkedLamp::environment) {
      options.environment.constant = Color::Ones();
      return scene().environment_link;
    }
    if (lamp == LinkedLamp::quad) {
      quad(material(lambert(Color::Zero(), Color::Constant(4.0f))), Vec3(-0.8f, 3, -1), Vec3(2, 0, 0),
           Vec3(0, 0, 2));
      return scene().instances.back().link;
    }
    scene::PunctualLight light = testing::point_light(Vec3(0, 3, 0), Color::Constant(9.0f));
    light.direction = Vec3(0, -1, 0);
    if (lamp == LinkedLamp::spot) light.type = scene::LightType::spot;
    if (lamp == LinkedLamp::sun) light = testing::sun(Vec3(0, -1, 0));
    scene().lights.push_back(light);
    return scene().lights.back().link;
  }
  /// The number of a set of these instances.
  int set(std::initializer_list<std::size_t> members, bool fog = false) {
    scene::ObjectSet set{std::vector<std::uint8_t>(scene().instances.size(), 0), fog};
    for (const std::size_t member : members) set.instances[member] = 1;
    scene().object_sets.push_back(set);
    return static_cast<int>(scene().object_sets.size()) - 1;
  }
  /// Expects the light of these lamps. `share`: 1, or 0 for none.
  void expect_light(std::initializer_list<LinkedLamp> lamps) {
    double irradiance = 0.0;
    for (const LinkedLamp lamp : lamps) {
      irradiance += lamp == LinkedLamp::environment ? M_PI : 1.0;
      if (lamp != LinkedLamp::quad) continue;
      irradiance += -1.0 + 4.0 * testing::triangles_irradiance(
                                     testing::quad(Vec3(-0.8f, 3, -1), Vec3(2, 0, 0), Vec3(0, 0, 2)),
                                     Vec3::Zero(), Vec3::UnitY());
    }
    const double expected = static_cast<double>(kAlbedo) / M_PI * irradiance;
    const Moments moments = seen();
    EXPECT_GT(testing::mean_p_value(moments, expected, 1e-3), kLinksSignificance)
        << "mean " << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
  }
};

TEST(Receivers, AloneGetTheLight) {
  for (const LinkedLamp lamp : kLinkedLamps) {
    for (const DirectLight direct : {DirectLight::mis, DirectLight::nee, DirectLight::bsdf}) {
      if (direct == DirectLight::bsdf && lamp < LinkedLamp::quad) continue;
      SCOPED_TRACE(::testing::Message() << static_cast<int>(lamp) << ", " << static_cast<int>(direct));
      for (const bool included : {true, false}) {
        LitFloor floor;
        floor.options.direct = direct;
        scene::LightLink& link = floor.add(lamp);
        link.receivers = included ? floor.set({kFloorNumber}) : floor.set({kWallsNumber}, true);
        if (included)
          floor.expect_light({lamp});
        else
          EXPECT_EQ(floor.seen().mean(), 0.0);
      }
    }
  }
}

TEST(Receivers, OfOneLightLeaveTheOthersAsTheyAre) {
  for (const LinkedLamp other : kLinkedLamps) {
    LitFloor floor;
    floor.add(other);
    scene::PunctualLight linked = testing::sun(Vec3(0, -1, 0.2f), Color::Constant(7.0f));
    linked.link.receivers = floor.set({kWallsNumber});
    floor.scene().lights.push_back(linked);
    floor.expect_light({other});
  }
}

TEST(Receivers, AndOthersCastShadows) {
  LitFloor floor;
  floor.box(0, Vec3(-9, 1, -9), Vec3(9, 1.5f, 9));
  floor.add(LinkedLamp::sun).receivers = floor.set({kFloorNumber});
  EXPECT_EQ(floor.seen().mean(), 0.0);
}

/// A floor below a plate that is much larger.
struct ShadedFloor : LitFloor {
  static constexpr std::size_t kPlate = 2;

  ShadedFloor() { box(0, Vec3(-2000, 1, -2000), Vec3(2000, 1.5f, 2000)); }
};

TEST(Blockers, AloneCastShadows) {
  for (const LinkedLamp lamp : kLinkedLamps) {
    SCOPED_TRACE(static_cast<int>(lamp));
    for (const DirectLight direct : {DirectLight::mis, DirectLight::nee}) {
      ShadedFloor shaded, open, unlinked, itself;
      for (ShadedFloor* floor : {&shaded, &open, &unlinked, &itself}) floor->options.direct = direct;
      unlinked.add(lamp);
      EXPECT_LT(unlinked.seen().mean(), 1e-6);
      scene::LightLink& by_plate = shaded.add(lamp);
      by_plate.blockers = shaded.set({ShadedFloor::kPlate});
      EXPECT_LT(shaded.seen().mean(), 1e-6);
      scene::LightLink& by_none = open.add(lamp);
      by_none.blockers = open.set({});
      open.expect_light({lamp});
      scene::LightLink& by_floor = itself.add(lamp);
      by_floor.blockers = itself.set({kWallsNumber, kFloorNumber});
      itself.expect_light({lamp});
    }
  }
}

TEST(Blockers, ThatShadowRaysDoNotSeeCastNone) {
  ShadedFloor floor;
  floor.add(LinkedLamp::sun).blockers = floor.set({ShadedFloor::kPlate});
  floor.scene().instances[ShadedFloor::kPlate].visibility.rays &= testing::all_but(scene::kShadowRays);
  floor.expect_light({LinkedLamp::sun});
}

TEST(Blockers, OfOneLightAreNotThoseOfOthers) {
  for (const LinkedLamp other : kLinkedLamps) {
    ShadedFloor floor;
    floor.add(other);
    scene::PunctualLight open = testing::sun(Vec3(0, -1, 0));
    open.link.blockers = floor.set({});
    floor.scene().lights.push_back(open);
    floor.options.spp = 512;
    floor.expect_light({LinkedLamp::sun});
  }
}

TEST(Blockers, OfEachLightMayDiffer) {
  const auto render = [](int sets) {
    ShadedFloor floor;
    floor.options.width = floor.options.height = 2;
    floor.options.spp = 512;
    const int open = floor.set({});
    for (int i = 0; i < sets; ++i) {
      scene::PunctualLight light = testing::sun(Vec3(0, -1, 0));
      scene::ObjectSet& set = floor.scene().object_sets.emplace_back(floor.scene().object_sets[0]);
      if (i > 0) {
        floor.box(0, Vec3(20.0f + static_cast<float>(i), 0, 0), Vec3(20.5f + static_cast<float>(i), 1, 1));
        for (scene::ObjectSet& each : floor.scene().object_sets) each.instances.push_back(0);
      }
      set.instances.back() = 1;
      light.link.blockers = open + 1 + i;
      floor.scene().lights.push_back(light);
    }
    return floor.seen().mean();
  };
  // The plate shades the first.
  const int most = scene::kMaxBlockerSets;
  EXPECT_NEAR(render(most), static_cast<double>(ShelteredFloor::kAlbedo) / M_PI * (most - 1), 0.05 * most);
  tests::expect_refusal<InputError>([&] { render(most + 1); }, {"built.glb", std::to_string(most)});
}

TEST(FogOfLights, IsAMemberOfItsOwn) {
  for (const LinkedLamp lamp : {LinkedLamp::point, LinkedLamp::sun, LinkedLamp::quad}) {
    for (const DirectLight direct : {DirectLight::mis, DirectLight::nee, DirectLight::bsdf}) {
      if (direct == DirectLight::bsdf && lamp != LinkedLamp::quad) continue;
      const auto picture = [&](std::optional<bool> member) {
        LitFloor floor;
        floor.scene().instances.pop_back();
        floor.walls().visibility.rays = scene::kCameraRays;
        floor.options.environment.fog = FogOptions{.density = 0.3f};
        floor.options.direct = direct;
        scene::LightLink& link = floor.add(lamp);
        if (member) link.receivers = floor.set({kWallsNumber}, *member);
        return floor.picture().layers[0].values;
      };
      SCOPED_TRACE(::testing::Message() << static_cast<int>(lamp) << ", " << static_cast<int>(direct));
      const std::vector<float> whole = picture(std::nullopt);
      EXPECT_GT(whole[0], 0.0f);
      EXPECT_EQ(picture(true), whole);
      EXPECT_EQ(picture(false), std::vector<float>(whole.size(), 0.0f));
    }
  }
}

TEST(BodiesOfLights, AreLitInsideWhereTheirSurfacesAre) {
  // Seen from outside, and from inside; alone, and touching another one.
  for (const float height : {2.5f, 0.4f}) {
    for (const bool another : {false, true}) {
      const auto picture = [&](std::optional<bool> member) {
        LitFloor floor;
        floor.scene().instances.pop_back();
        scene::Material milk = testing::solid_glass(1.0f);
        milk.attenuation_distance = 0.5f;
        milk.attenuation_color.setConstant(0.5f);
        milk.multiscatter_color.setConstant(0.7f);
        for (int i = 0; i < (another ? 2 : 1); ++i) {
          const float x = static_cast<float>(i);
          floor.box(floor.material(milk), Vec3(x - 1, -1, -1), Vec3(x + 1, 1, 1));
          floor.scene().instances.back().placement = i;
        }
        floor.options.camera.look_at->eye.y() = height;
        floor.options.camera.look_at->target.y() = -1.0f;
        floor.options.glass_shadows = GlassShadows::straight;
        floor.options.spp = 8;
        scene::LightLink& link = floor.add(LinkedLamp::point);
        if (member && *member) link.receivers = another ? floor.set({1, 2}) : floor.set({1});
        if (member && !*member) link.receivers = floor.set({kWallsNumber}, true);
        return floor.picture().layers[0].values;
      };
      SCOPED_TRACE(::testing::Message() << height << another);
      const std::vector<float> whole = picture(std::nullopt);
      EXPECT_GT(whole[0], 0.0f);
      EXPECT_EQ(picture(true), whole);
      EXPECT_EQ(picture(false), std::vector<float>(whole.size(), 0.0f));
    }
  }
}

}  // namespace
}  // namespace gatelight::renderer
