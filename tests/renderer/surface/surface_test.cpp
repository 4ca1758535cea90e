// The material at a hit, and normal maps in mirrored instances and from behind: the visible surface does not
// depend on how its mesh came to its place.

#include "renderer/surface/surface.h"

#include <gtest/gtest.h>

#include "renderer/image/srgb.h"
#include "scene/bake.h"
#include "tests/support/scene_builder.h"

namespace gatelight::renderer {
namespace {

using gatelight::testing::SceneBuilder;

/// A square in the xy plane, moved by `transform`. Its normal map leans the normals towards the tangent x and
/// the bitangent y; its clear coat has the same map, half as strong.
scene::Scene leaning(const Affine& transform) {
  SceneBuilder builder;
  scene::Material material;
  material.normal_texture.texture = 0;
  material.clearcoat = 1.0f;
  material.clearcoat_normal_texture.texture = 0;
  material.clearcoat_normal_scale = 0.5f;
  scene::Mesh& mesh = builder.quad(builder.material(material), Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0));
  mesh.normals.assign(4, Vec3(0, 0, 1));
  mesh.tangents.assign(4, Vec4(1, 0, 0, 1));
  mesh.uv0 = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  scene::Scene& scene = builder.scene();
  scene.images.push_back({.name = "lean", .width = 1, .height = 1, .channels = 3, .pixels = {160, 220, 230}});
  scene.textures.push_back({.image = 0});
  scene.instances[0].baked = false;
  scene.instances[0].transform = transform;
  scene.instances[0].swaps_handedness = transform.linear().determinant() < 0.0f;
  return scene;
}

struct Normals {
  Vec3 shading;
  Vec3 coat;
};

/// The normals at the hit of a ray against `towards`.
Normals seen(const scene::Scene& scene, const Vec3& towards) {
  const Textures textures(scene);
  const Surfaces surfaces(scene, textures);
  const Hit hit{.u = 0.25f, .v = 0.25f, .instance = 0};
  const Surface surface = surfaces.at(hit, -towards, 0.0f, 0.0f);
  return {surface.shading_normal, surface.coat_normal};
}

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT((a - b).norm(), 1e-5f) << a.transpose() << " and " << b.transpose();
}

Affine turned_and_scaled(const Vec3& scale) {
  Affine transform(Eigen::AngleAxisf(0.7f, Vec3(1, 2, -1).normalized()));
  return transform.scale(scale);
}

TEST(NormalMaps, LeanTowardsTangentAndBitangent) {
  // Bytes 160, 220, 230 over 255, times two, less one.
  const Vec3 texel(160.0f / 127.5f - 1.0f, 220.0f / 127.5f - 1.0f, 230.0f / 127.5f - 1.0f);
  const Normals normals = seen(leaning(Affine::Identity()), Vec3(0.1f, 0.2f, 0.9f).normalized());
  expect_near(normals.shading, texel.normalized());
  expect_near(normals.coat, Vec3(0.5f * texel.x(), 0.5f * texel.y(), texel.z()).normalized());
}

TEST(NormalMaps, SixteenBitsShowASlopeOfOneInAThousand) {
  scene::Scene scene = leaning(Affine::Identity());
  const auto slope = [&] {
    const Vec3 n = seen(scene, Vec3(0, 0, 1)).shading;
    return Vec2(n.x() / n.z(), n.y() / n.z());
  };
  // (1 + slope) / 2, in 65535ths and in 255ths.
  scene.images[0].pixels_16 = {32800, 32735, 65535};
  EXPECT_NEAR(slope().x(), 0.001f, 1.6e-5f);
  EXPECT_NEAR(slope().y(), -0.001f, 1.6e-5f);
  scene.images[0].pixels_16.clear();
  scene.images[0].pixels = {128, 127, 255};
  EXPECT_NEAR(slope().x(), 1.0f / 255.0f, 1e-6f) << "the next of 8 bits";
}

TEST(NormalMaps, FromBehindLeanAsFromTheFront) {
  const Normals front = seen(leaning(Affine::Identity()), Vec3(0, 0, 1));
  const Normals back = seen(leaning(Affine::Identity()), Vec3(0, 0, -1));
  expect_near(back.shading, Vec3(front.shading.x(), front.shading.y(), -front.shading.z()));
  expect_near(back.coat, Vec3(front.coat.x(), front.coat.y(), -front.coat.z()));
}

TEST(NormalMaps, AMirroredInstanceShowsTheMirrorImage) {
  for (const Vec3& mirror : {Vec3(-1, 1, 1), Vec3(1, -1, 1), Vec3(1, 1, -1), Vec3(-1, -1, -1)}) {
    for (const Vec3& towards :
         {Vec3(0.2f, -0.3f, 0.8f).normalized(), Vec3(0.2f, -0.3f, -0.8f).normalized()}) {
      const Affine place = turned_and_scaled(mirror);
      const Normals here = seen(leaning(Affine::Identity()), towards);
      const Normals there = seen(leaning(place), place.linear() * towards);
      expect_near(there.shading, place.linear() * here.shading);
      expect_near(there.coat, place.linear() * here.coat);
    }
  }
}

TEST(NormalMaps, AnInstanceLooksLikeItsMeshMovedIntoTheWorld) {
  for (const Vec3& scale : {Vec3(2, 2, 2), Vec3(-2, 2, 2), Vec3(0.5f, -0.5f, 0.5f)}) {
    for (const Vec3& towards : {Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
      const scene::Scene placed = leaning(turned_and_scaled(scale));
      scene::Scene baked = placed;
      scene::bake_transforms(baked);
      ASSERT_TRUE(baked.instances[0].baked);
      const Vec3 world = turned_and_scaled(Vec3::Ones()).linear() * towards;
      expect_near(seen(placed, world).shading, seen(baked, world).shading);
      expect_near(seen(placed, world).coat, seen(baked, world).coat);
    }
  }
}

/// A square of the material, all of whose textures are a picture of two texels: the first set of coordinates
/// finds one, the second the other.
scene::Scene painted(const scene::Material& material) {
  SceneBuilder builder;
  scene::Mesh& mesh = builder.quad(builder.material(material), Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 1, 0));
  mesh.uv0.assign(4, Vec2(0.25f, 0.5f));
  mesh.uv1.assign(4, Vec2(0.75f, 0.5f));
  scene::Scene& scene = builder.scene();
  scene.images.push_back({.name = "two",
                          .width = 2,
                          .height = 1,
                          .channels = 4,
                          .pixels = {200, 128, 64, 32, 100, 50, 150, 250}});
  scene.textures.push_back({.image = 0});
  return scene;
}

Surface front_of(const scene::Scene& scene) {
  const Textures textures(scene);
  const Hit hit{.u = 0.25f, .v = 0.25f, .instance = 0};
  return Surfaces(scene, textures).at(hit, Vec3(0, 0, -1), 0.0f, 0.0f);
}

/// A member that a surface takes from its material, times a channel of a texture or its colour.
template <class Value>
struct Part {
  Value scene::Material::*factor;
  Value SurfaceMaterial::*seen;
  scene::TextureSlot scene::Material::*texture;
  int channel = 0;
};
using scene::Material;
const Part<float> kNumbers[] = {
    {&Material::metallic, &SurfaceMaterial::metallic, &Material::metallic_roughness_texture, 2},
    {&Material::roughness, &SurfaceMaterial::roughness, &Material::metallic_roughness_texture, 1},
    {&Material::specular, &SurfaceMaterial::specular, &Material::specular_texture, 3},
    {&Material::transmission, &SurfaceMaterial::transmission, &Material::transmission_texture, 0},
    {&Material::clearcoat, &SurfaceMaterial::clearcoat, &Material::clearcoat_texture, 0},
    {&Material::clearcoat_roughness, &SurfaceMaterial::clearcoat_roughness,
     &Material::clearcoat_roughness_texture, 1},
    {&Material::sheen_roughness, &SurfaceMaterial::sheen_roughness, &Material::sheen_roughness_texture, 3},
    {&Material::diffuse_transmission, &SurfaceMaterial::diffuse_transmission,
     &Material::diffuse_transmission_texture, 3}};
const Part<Color> kColors[] = {
    {&Material::base_color, &SurfaceMaterial::base_color, &Material::base_color_texture},
    {&Material::specular_color, &SurfaceMaterial::specular_color, &Material::specular_color_texture},
    {&Material::sheen_color, &SurfaceMaterial::sheen_color, &Material::sheen_color_texture},
    {&Material::diffuse_transmission_color, &SurfaceMaterial::diffuse_transmission_color,
     &Material::diffuse_transmission_color_texture}};

/// A material in which every factor has a value of its own.
Material rich_material() {
  Material m;
  m.emission = Color(3.0f, 2.0f, 1.0f);
  m.ior = 1.7f;
  float value = 0.95f;
  for (const auto& part : kNumbers) m.*part.factor = value -= 0.08f;
  for (const auto& part : kColors) m.*part.factor = (value -= 0.02f) * Color(1.0f, 0.8f, 0.6f);
  return m;
}

/// Expects the factors of the material times a texel of all its textures, none for white ones.
void expect_product(const Surface& s, const Material& m, const std::uint8_t* texel = nullptr) {
  const auto linear = [&](int channel) { return texel ? static_cast<float>(texel[channel]) / 255.0f : 1.0f; };
  const Color color(srgb_to_linear(linear(0)), srgb_to_linear(linear(1)), srgb_to_linear(linear(2)));
  const auto same = [](const Color& a, const Color& b) { return (a - b).abs().maxCoeff() < 1e-5f; };
  for (const auto& part : kNumbers)
    EXPECT_NEAR(s.material.*part.seen, m.*part.factor * linear(part.channel), 1e-5f) << &part - kNumbers;
  for (const auto& part : kColors)
    EXPECT_TRUE(same(s.material.*part.seen, m.*part.factor * color)) << &part - kColors;
  EXPECT_TRUE(same(s.emission, m.emission * color)) << s.emission.transpose();
  EXPECT_EQ(s.material.ior, m.ior);
}

TEST(Surfaces, HaveTheFactorsOfTheirMaterial) {
  Material m = rich_material();
  const Surface thin = front_of(painted(m));
  expect_product(thin, m);
  EXPECT_TRUE(thin.material.thin_walled);
  EXPECT_FALSE(thin.unlit);
  m.thickness = 0.1f;
  EXPECT_FALSE(front_of(painted(m)).material.thin_walled);
}

TEST(Surfaces, GlossinessIsTheAlphaOfItsTexture) {
  Material m = rich_material();
  m.roughness = 0.25f;
  m.glossiness_texture.texture = 0;
  const scene::Scene scene = painted(m);
  const float alpha = static_cast<float>(scene.images[0].pixels[3]) / 255.0f;
  EXPECT_NEAR(front_of(scene).material.roughness, 1.0f - 0.75f * alpha, 1e-6f);
}

TEST(Surfaces, TexturesMultiplyTheFactorsEachByItsChannels) {
  for (const int set : {0, 1}) {
    Material m = rich_material();
    const auto set_texture = [&](const auto& part) {
      (m.*part.texture).texture = 0;
      (m.*part.texture).texcoord = set;
    };
    for (const auto& part : kNumbers) set_texture(part);
    for (const auto& part : kColors) set_texture(part);
    m.emission_texture = m.base_color_texture;
    const scene::Scene scene = painted(m);
    expect_product(front_of(scene), m, &scene.images[0].pixels[set == 0 ? 0 : 4]);
  }
}

TEST(Surfaces, AnisotropicOnesAreRoughAlongTheirTangentTurnedByAngleAndTexture) {
  scene::Material m;
  m.anisotropy = 0.5f;
  const auto anisotropic = [&](float rotation, bool texture, float handedness = 1.0f) {
    m.anisotropy_rotation = rotation;
    m.anisotropy_texture.texture = texture ? 0 : -1;
    scene::Scene scene = painted(m);
    // Halfway up from the direction of the tangent, and half of the strength.
    for (std::size_t i = 0; i < scene.images[0].pixels.size(); i += 4) {
      const std::uint8_t texel[] = {255, 255, 51, 255};
      std::copy_n(texel, 4, &scene.images[0].pixels[i]);
    }
    scene.meshes[0].tangents.assign(scene.meshes[0].positions.size(), Vec4(1, 0, 0, handedness));
    return front_of(scene).material;
  };
  const auto turned = [](float angle) { return Vec3(std::cos(angle), std::sin(angle), 0.0f); };
  EXPECT_EQ(anisotropic(0.0f, false).anisotropy, 0.5f);
  EXPECT_TRUE(anisotropic(0.0f, false).anisotropy_direction.isApprox(turned(0.0f), 1e-5f));
  EXPECT_TRUE(anisotropic(0.7f, false).anisotropy_direction.isApprox(turned(0.7f), 1e-5f));
  EXPECT_TRUE(anisotropic(0.7f, false, -1.0f).anisotropy_direction.isApprox(turned(-0.7f), 1e-5f))
      << "a mirrored frame";
  EXPECT_TRUE(anisotropic(0.7f, true).anisotropy_direction.isApprox(turned(0.7f + 0.25f * kPi), 1e-4f));
  EXPECT_NEAR(anisotropic(0.0f, true).anisotropy, 0.5f * 0.2f, 1e-4f);
  m.anisotropy = 0.0f;
  EXPECT_EQ(anisotropic(0.0f, true).anisotropy, 0.0f);
}

TEST(Surfaces, VertexColoursMultiplyTheBaseColour) {
  Material m = rich_material();
  scene::Scene scene = painted(m);
  scene.meshes[0].colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 1}, {9, 9, 9, 1}};
  m.base_color *= Color(0.5f, 0.25f, 0.25f);
  expect_product(front_of(scene), m);
}

TEST(Surfaces, UnlitOnesEmitOnlyTheirBaseColour) {
  Material m = rich_material();
  m.unlit = true;
  const Surface s = front_of(painted(m));
  EXPECT_TRUE(s.unlit);
  EXPECT_TRUE((s.emission == m.base_color).all());
}

}  // namespace
}  // namespace gatelight::renderer
