#pragma once
// What there is: plain data, filled by a loader (scene/gltf.h), read by everyone else.
// Indices instead of pointers; an index of -1 means "none".

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/math.h"

namespace gatelight::scene {

/// A decoded picture: 8 bits a channel, 1 to 4 channels (grey, grey-alpha, RGB, RGBA), rows from the top.
/// Whether the bytes are sRGB or linear is decided by the slot of the material that reads them.
struct Image {
  std::string name;  ///< file name, or the name inside the glTF file, for messages
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<std::uint8_t> pixels;  ///< width * height * channels bytes
};

enum class Wrap : std::uint8_t { repeat, mirrored_repeat, clamp_to_edge };

struct Texture {
  int image = -1;
  Wrap wrap_s = Wrap::repeat;
  Wrap wrap_t = Wrap::repeat;
  bool nearest = false;  ///< magnification filter of the file's sampler is NEAREST
};

/// A material's use of a texture.
struct TextureSlot {
  int texture = -1;
  int texcoord = 0;  ///< 0 or 1: which of the mesh's UV sets
  /// KHR_texture_transform, applied to a column (u, v, 1): rotation, scale, offset in one matrix.
  Eigen::Matrix<float, 2, 3> transform = Eigen::Matrix<float, 2, 3>::Identity();

  explicit operator bool() const { return texture >= 0; }
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// glTF 2.0 metallic-roughness with the extensions named beside the members. A texture multiplies its factor.
struct Material {
  std::string name;

  Color base_color{1.0f, 1.0f, 1.0f};
  float base_alpha = 1.0f;
  TextureSlot base_color_texture;  ///< RGB sRGB, A linear
  float metallic = 1.0f;
  float roughness = 1.0f;                  ///< perceptual; alpha of GGX is its square
  TextureSlot metallic_roughness_texture;  ///< G roughness, B metallic
  TextureSlot normal_texture;              ///< tangent space, +Y up
  float normal_scale = 1.0f;
  Color emission{0.0f, 0.0f, 0.0f};  ///< radiance: emissiveFactor times KHR_materials_emissive_strength
  TextureSlot emission_texture;      ///< RGB sRGB
  AlphaMode alpha_mode = AlphaMode::opaque;
  float alpha_cutoff = 0.5f;
  bool double_sided = false;
  bool unlit = false;  ///< KHR_materials_unlit

  float ior = 1.5f;                           ///< KHR_materials_ior; 0 means Fresnel is 1 everywhere
  float specular = 1.0f;                      ///< KHR_materials_specular
  TextureSlot specular_texture;               ///< A
  Color specular_color{1.0f, 1.0f, 1.0f};     ///< KHR_materials_specular
  TextureSlot specular_color_texture;         ///< RGB sRGB
  float transmission = 0.0f;                  ///< KHR_materials_transmission
  TextureSlot transmission_texture;           ///< R
  float thickness = 0.0f;                     ///< KHR_materials_volume; 0 is thin-walled
  float attenuation_distance = kInfinity;     ///< KHR_materials_volume, metres
  Color attenuation_color{1.0f, 1.0f, 1.0f};  ///< KHR_materials_volume
  float clearcoat = 0.0f;                     ///< KHR_materials_clearcoat
  TextureSlot clearcoat_texture;              ///< R
  float clearcoat_roughness = 0.0f;
  TextureSlot clearcoat_roughness_texture;  ///< G
  TextureSlot clearcoat_normal_texture;
  float clearcoat_normal_scale = 1.0f;
  Color sheen_color{0.0f, 0.0f, 0.0f};  ///< KHR_materials_sheen
  TextureSlot sheen_color_texture;      ///< RGB sRGB
  float sheen_roughness = 0.0f;
  TextureSlot sheen_roughness_texture;  ///< A

  bool emits() const { return (emission > 0.0f).any(); }
  bool transmits() const { return transmission > 0.0f; }
  /// Light passes through to an interior (with absorption), not through an infinitely thin sheet.
  bool has_volume() const { return transmits() && thickness > 0.0f; }
};

/// One triangle list with one material: a glTF primitive. Optional arrays are empty when the file has none or
/// no material of the scene reads them; otherwise they have one entry per position.
/// Counter-clockwise is the front, in the space of the mesh.
struct Mesh {
  std::string name;
  int material = -1;            ///< index into Scene::materials, always valid after loading
  std::vector<Vec3> positions;  ///< capacity is at least one more than size: Embree reads 16 bytes a vertex
  std::vector<Vec3> normals;    ///< unit; empty means flat: the geometric normal of each triangle
  std::vector<Vec4>
      tangents;  ///< xyz unit, w the handedness (+1 or -1); present when a normal map needs them
  std::vector<Vec2> uv0;
  std::vector<Vec2> uv1;
  std::vector<Vec4> colors;  ///< COLOR_0, linear RGBA, multiplies the base colour
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A mesh in the world. Instances that share a mesh are drawn by Embree as instances; a mesh that is used
/// once holds world-space vertices and its instance is the identity (scene/bake.h).
struct Instance {
  std::string name;
  int mesh = -1;
  Affine transform = Affine::Identity();  ///< mesh to world
  bool baked = false;                     ///< the mesh is in world space and used by nobody else
  bool mirrors = false;                   ///< determinant < 0: the world's front is clockwise in the mesh
};

enum class LightType : std::uint8_t { directional, point, spot };

/// KHR_lights_punctual. Intensities are taken as radiometric numbers.
struct PunctualLight {
  std::string name;
  LightType type = LightType::point;
  Color intensity{1.0f, 1.0f,
                  1.0f};  ///< colour times intensity: W/sr (point, spot) or W/m2 facing it (directional)
  Vec3 position = Vec3::Zero();       ///< world; not for directional
  Vec3 direction{0.0f, 0.0f, -1.0f};  ///< world, unit: the way the light travels; not for point
  float range = kInfinity;        ///< metres; beyond it the light is zero, by the extension's window function
  float cos_inner = 1.0f;         ///< spot: cosine of the inner cone angle
  float cos_outer = 0.70710678f;  ///< spot: cosine of the outer cone angle
};

/// Looks along -z of its transform, y up.
struct Camera {
  std::string name;
  Affine transform = Affine::Identity();  ///< camera to world, without scale
  bool orthographic = false;
  float vertical_fov = 0.8f;  ///< radians; perspective
  float aspect = 0.0f;        ///< width over height; 0 means that of the picture
  float half_height = 1.0f;   ///< metres (ymag); orthographic
  float half_width = 0.0f;    ///< metres (xmag); orthographic; 0 means half_height times the picture's aspect
};

struct Scene {
  std::string path;  ///< the file it was loaded from
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<PunctualLight> lights;
  std::vector<Camera> cameras;
  std::vector<std::string> variants;  ///< names of KHR_materials_variants
  std::vector<std::string> warnings;  ///< one line each, said once
  Box bounds;                         ///< world; empty when there is no triangle
  /// Where the world's zero lies in the file's coordinates: not zero where the file's scene is far from its
  /// origin, beside its size, so that single precision would hold little of it (scene/gltf.h).
  Vec3 origin = Vec3::Zero();

  const Mesh& mesh_of(const Instance& instance) const {
    return meshes[static_cast<std::size_t>(instance.mesh)];
  }
  const Material& material_of(const Instance& instance) const {
    return materials[static_cast<std::size_t>(mesh_of(instance).material)];
  }
};

/// The corners of a triangle in the world, in the order of the file.
std::array<Vec3, 3> world_triangle(const Scene& scene, const Instance& instance, std::uint32_t primitive);

/// Unit normal of a triangle in the world, counter-clockwise, for mirrored instances too; zero where the
/// corners lie on a line.
Vec3 world_normal(const Scene& scene, const Instance& instance, std::uint32_t primitive);

/// Square metres of a triangle in the world.
double world_area(const Scene& scene, const Instance& instance, std::uint32_t primitive);

/// Number of triangles, each instance counted.
std::size_t count_triangles(const Scene& scene);

/// Bytes held by vertices and indices, and by decoded images.
std::size_t geometry_bytes(const Scene& scene);
std::size_t image_bytes(const Scene& scene);

}  // namespace gatelight::scene
