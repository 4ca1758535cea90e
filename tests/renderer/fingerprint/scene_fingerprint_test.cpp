#include "renderer/fingerprint/scene_fingerprint.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <functional>

#include "base/file/digest.h"
#include "tests/support/messages.h"
#include "tests/support/scene_builder.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {

namespace {

using testing::SceneBuilder;
using tests::expect_refusal;
using tests::TemporaryFolder;

/// A scene with something of everything.
scene::Scene varied_scene() {
  SceneBuilder builder;
  scene::Material textured = SceneBuilder::lambert(Color(0.8f, 0.7f, 0.6f));
  textured.base_color_texture.texture = 0;
  const int a = builder.material(textured);
  const int b = builder.material(SceneBuilder::lambert(Color::Zero(), Color::Constant(10.0f)));
  scene::Mesh& quad = builder.quad(a, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  quad.uv0 = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
  quad.colors.assign(4, Vec4::Ones());
  builder.sphere(b, Vec3(2, 0, 0), 1.0f, 16, true);
  scene::Scene& s = builder.scene();
  s.images.push_back({"picture", 2, 1, 3, {1, 2, 3, 4, 5, 6}});
  s.textures.push_back({.image = 0});
  s.lights.push_back({});
  s.cameras.push_back({});
  return s;
}

/// Refers to a set of the first object only.
void link(scene::Scene& s, int& set) {
  s.object_sets = {{{1, 0}, false}};
  set = 0;
}

/// The names of the parts that differ: "geometry, lights".
std::string differing_parts(const SceneFingerprint& a, const SceneFingerprint& b) {
  std::string parts;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b.at(i)) parts += (parts.empty() ? "" : ", ") + a[i].name;
  }
  return parts;
}

using Change = std::function<void(scene::Scene&, EnvironmentOptions&)>;

std::string changed(const Change& change) {
  scene::Scene s = varied_scene();
  EnvironmentOptions environment;
  environment.constant = Color(1.0f, 2.0f, 3.0f);
  const SceneFingerprint before = compute_scene_fingerprint(s, environment);
  change(s, environment);
  return differing_parts(before, compute_scene_fingerprint(s, environment));
}

TEST(SceneFingerprint, EachChangeShowsOnlyInItsPart) {
  using S = scene::Scene&;
  using E = EnvironmentOptions&;
  const std::vector<std::pair<const char*, Change>> cases = {
      {"geometry", [](S s, E) { s.meshes[0].positions[1].y() += 1e-6f; }},
      {"geometry", [](S s, E) { std::swap(s.meshes[1].triangles[0], s.meshes[1].triangles[1]); }},
      {"geometry", [](S s, E) { std::swap(s.meshes[1].triangles[0][0], s.meshes[1].triangles[0][1]); }},
      {"geometry", [](S s, E) { s.instances[1].transform(2, 3) = 0.5f; }},
      {"geometry", [](S s, E) { s.instances[1].mesh = 0; }},
      {"geometry", [](S s, E) { s.instances[0].baked = false; }},
      {"geometry", [](S s, E) { s.instances.pop_back(); }},
      {"geometry", [](S s, E) { s.instances[0].visibility.rays = scene::kCameraRays; }},
      {"geometry", [](S s, E) { s.instances[1].visibility.holdout = true; }},
      {"geometry", [](S s, E) { s.instances[1].visibility.shadow_catcher = true; }},
      {"attributes", [](S s, E) { s.meshes[1].normals[3] = Vec3(0, 0, 1); }},
      {"attributes", [](S s, E) { s.meshes[0].uv0[2].x() = 0.5f; }},
      {"attributes", [](S s, E) { std::swap(s.meshes[0].uv0, s.meshes[0].uv1); }},
      {"attributes", [](S s, E) { s.meshes[0].colors[0].w() = 0.5f; }},
      {"attributes", [](S s, E) { s.meshes[0].tangents.assign(4, Vec4(1, 0, 0, 1)); }},
      {"materials", [](S s, E) { s.materials[0].base_color.y() = 0.71f; }},
      {"materials", [](S s, E) { s.materials[1].emission.x() = 11.0f; }},
      {"materials", [](S s, E) { s.materials[0].double_sided = true; }},
      {"materials", [](S s, E) { s.materials[0].sheen_roughness = 0.1f; }},
      {"materials", [](S s, E) { s.materials[0].alpha_mode = scene::AlphaMode::blend; }},
      {"materials", [](S s, E) { s.materials[1].clearcoat_normal_texture.texture = 0; }},
      {"materials", [](S s, E) { s.materials[0].base_color_texture.transform(0, 2) = 0.5f; }},
      {"materials", [](S s, E) { s.materials[0].base_color_texture.texcoord = 1; }},
      {"materials", [](S s, E) { s.meshes[0].material = 1; }},
      {"materials", [](S s, E) { s.images[0].pixels[5] = 7; }},
      {"materials", [](S s, E) { s.images[0].pixels_16 = {1, 2, 3, 4, 5, 6}; }},
      {"materials", [](S s, E) { std::swap(s.images[0].width, s.images[0].height); }},
      {"materials", [](S s, E) { s.textures[0].wrap_t = scene::Wrap::clamp_to_edge; }},
      {"lights", [](S s, E) { s.lights[0].intensity.z() = 2.0f; }},
      {"lights", [](S s, E) { s.lights[0].type = scene::LightType::spot; }},
      {"lights", [](S s, E) { s.lights[0].cos_outer = 0.5f; }},
      {"lights", [](S s, E) { s.lights.clear(); }},
      {"lights", [](S s, E) { s.lights[0].rays = scene::kDiffuseRays; }},
      {"lights", [](S s, E) { s.environment_rays = scene::kBounceRays; }},
      {"lights", [](S s, E) { link(s, s.lights[0].link.receivers); }},
      {"lights", [](S s, E) { link(s, s.lights[0].link.blockers); }},
      {"lights", [](S s, E) { link(s, s.instances[1].link.receivers); }},
      {"lights", [](S s, E) { link(s, s.environment_link.blockers); }},
      {"environment", [](S, E e) { e.constant.x() = 0.5f; }},
      {"environment", [](S, E e) { e.scale = 2.0f; }},
      {"environment", [](S, E e) { e.sky.emplace(); }},
      {"", [](S, E e) { e.rotation_degrees = 90.0f; }},  // of a constant
      {"", [](S s, E) { s.cameras[0].vertical_fov = 0.1f; }},
      {"", [](S s, E) { s.path = s.meshes[0].name = s.materials[0].name = s.lights[0].name = "other"; }},
      {"", [](S s, E) { s.meshes[0].positions.shrink_to_fit(); }},
      {"geometry, attributes, materials",
       [](S s, E) {
         s.meshes.pop_back();
         s.instances.pop_back();
       }},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(changed(cases[i].second), cases[i].first) << "case " << i;
  }
}

TEST(SceneFingerprint, SetsOfObjectsCountByTheirMembers) {
  scene::Scene s = varied_scene();
  link(s, s.lights[0].link.receivers);
  const SceneFingerprint before = compute_scene_fingerprint(s, {});
  s.object_sets[0].fog = true;
  const SceneFingerprint with_fog = compute_scene_fingerprint(s, {});
  EXPECT_EQ(differing_parts(with_fog, before), "lights");
  s.object_sets[0].instances = {0, 1};
  EXPECT_EQ(differing_parts(compute_scene_fingerprint(s, {}), with_fog), "lights");
}

TEST(SceneFingerprint, HasNothingAboutRaysAndLinksWhereAllSeeAndLightAll) {
  scene::Scene s = varied_scene();
  s.lights.clear();
  for (const NamedText& part : compute_scene_fingerprint(s, {})) {
    if (part.name == "lights") {
      EXPECT_EQ(part.text, hexadecimal(DigestRecord().digest())) << "as in earlier versions";
    }
  }
}

TEST(SceneFingerprint, ASkyIsEachOfItsPartsAndItsTurn) {
  const scene::Scene s = varied_scene();
  EnvironmentOptions options;
  options.sky.emplace();
  const SceneFingerprint before = compute_scene_fingerprint(s, options);
  const auto differs = [&](const std::function<void(EnvironmentOptions&)>& change) {
    EnvironmentOptions other = options;
    change(other);
    return differing_parts(compute_scene_fingerprint(s, other), before);
  };
  using E = EnvironmentOptions&;
  const std::vector<std::function<void(EnvironmentOptions&)>> changes = {
      [](E e) { e.sky->turbidity = 2.0f; },
      [](E e) { e.sky->sun_azimuth_degrees += 1e-4f; },
      [](E e) { e.sky->sun_elevation_degrees = 3; },
      [](E e) { e.sky->time = SunTime(); },
      [](E e) { e.sky->ground = 0.3f; },
      [](E e) { e.sky->sun_size_degrees = 0.0f; },
      [](E e) { e.sky->intensity = 2.0f; },
      [](E e) { e.rotation_degrees = 1.0f; },
      [](E e) { e.scale = 2.0f; }};
  for (std::size_t i = 0; i < changes.size(); ++i) EXPECT_EQ(differs(changes[i]), "environment") << i;
  EXPECT_EQ(differs([](E) {}), "");
}

TEST(SceneFingerprint, AnEnvironmentIsItsFilesContentAndItsTurn) {
  const TemporaryFolder folder;
  EnvironmentOptions options;
  options.file = folder.write("a.hdr", "pixels");
  const scene::Scene s = varied_scene();
  const SceneFingerprint before = compute_scene_fingerprint(s, options);
  options.file = folder.write("b.hdr", "pixels");
  EXPECT_EQ(compute_scene_fingerprint(s, options), before);
  options.rotation_degrees = 90.0f;
  EXPECT_EQ(differing_parts(compute_scene_fingerprint(s, options), before), "environment");
  options.rotation_degrees = 0.0f;
  folder.write("b.hdr", "pixelz");
  EXPECT_EQ(differing_parts(compute_scene_fingerprint(s, options), before), "environment");
  options.file = folder / "none.hdr";
  expect_refusal<InputError>([&] { compute_scene_fingerprint(s, options); }, {options.file});
}

TEST(SceneFingerprint, ThreadsAndASecondCopyChangeNothing) {
  SceneBuilder builder;
  const int grey = builder.material(SceneBuilder::lambert(Color::Constant(0.5f)));
  for (int i = 0; i < 200; ++i) builder.sphere(grey, Vec3(static_cast<float>(i), 0, 0), 0.5f, 12, true);
  const scene::Scene copy = builder.scene();
  const SceneFingerprint first = compute_scene_fingerprint(builder.scene(), {});
  for (const std::size_t threads : {1, 2, 7}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(compute_scene_fingerprint(copy, {}), first);
  }
}

}  // namespace
}  // namespace gatelight::renderer
