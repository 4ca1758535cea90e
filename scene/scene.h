#pragma once
// The scene as plain data. A loader fills it (scene/gltf.h); all other code only reads it. Objects refer to
// each other by index; -1 means "none".

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "base/padded_vector.h"
#include "scene/ies_profile.h"
#include "scene/visibility.h"

namespace gatelight::scene {

/// A decoded picture: 1 to 4 channels (grey, grey-alpha, RGB, RGBA), rows from the top. The material slot
/// that reads the values decides whether they are sRGB or linear.
struct Image {
  std::string name;  ///< file name, or the name inside the glTF file, for messages
  int width = 0;
  int height = 0;
  int channels = 0;
  std::vector<std::uint8_t> pixels;           ///< width * height * channels values
  std::vector<std::uint16_t> pixels_16 = {};  ///< used instead of `pixels` by 16-bit normal maps
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
  int texcoord = 0;  ///< 0 or 1: index of the mesh's UV set
  /// KHR_texture_transform, applied to a column (u, v, 1): rotation, scale, offset in one matrix.
  Eigen::Matrix<float, 2, 3> transform = Eigen::Matrix<float, 2, 3>::Identity();

  explicit operator bool() const { return texture >= 0; }
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// The metallic-roughness material of glTF 2.0, with the extensions named in the members' comments. Each
/// factor is multiplied by its texture.
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
  bool culled = false;  ///< rays pass its back faces (BackFaces::cull)
  bool unlit = false;   ///< KHR_materials_unlit

  float ior = 1.5f;                        ///< KHR_materials_ior; 0 means Fresnel is 1 everywhere
  float specular = 1.0f;                   ///< KHR_materials_specular
  TextureSlot specular_texture;            ///< A
  Color specular_color{1.0f, 1.0f, 1.0f};  ///< KHR_materials_specular
  TextureSlot specular_color_texture;      ///< RGB sRGB
  /// A: multiplies 1 - roughness (KHR_materials_pbrSpecularGlossiness).
  TextureSlot glossiness_texture;
  float transmission = 0.0f;                  ///< KHR_materials_transmission
  TextureSlot transmission_texture;           ///< R
  float thickness = 0.0f;                     ///< KHR_materials_volume; 0 is thin-walled
  float attenuation_distance = kInfinity;     ///< KHR_materials_volume, metres
  Color attenuation_color{1.0f, 1.0f, 1.0f};  ///< KHR_materials_volume
  /// KHR_materials_volume_scatter: diffuse reflectance of a half space filled with the interior medium.
  Color multiscatter_color{0.0f, 0.0f, 0.0f};
  float scatter_anisotropy = 0.0f;   ///< in (-1, 1): mean cosine of scattering in the interior
  float dispersion = 0.0f;           ///< KHR_materials_dispersion: 20 over the Abbe number
  float anisotropy = 0.0f;           ///< KHR_materials_anisotropy
  float anisotropy_rotation = 0.0f;  ///< radians, counter-clockwise from the tangent
  TextureSlot anisotropy_texture;    ///< RG the direction, B multiplies the strength
  float iridescence = 0.0f;          ///< KHR_materials_iridescence
  TextureSlot iridescence_texture;   ///< R
  float film_ior = 1.3f;
  float film_thickness_minimum = 100.0f;  ///< nanometres; only used with a texture
  float film_thickness_maximum = 400.0f;
  TextureSlot film_thickness_texture;  ///< G, from the minimum to the maximum
  float clearcoat = 0.0f;              ///< KHR_materials_clearcoat
  TextureSlot clearcoat_texture;       ///< R
  float clearcoat_roughness = 0.0f;
  TextureSlot clearcoat_roughness_texture;  ///< G
  TextureSlot clearcoat_normal_texture;
  float clearcoat_normal_scale = 1.0f;
  float diffuse_transmission = 0.0f;         ///< KHR_materials_diffuse_transmission
  TextureSlot diffuse_transmission_texture;  ///< A
  Color diffuse_transmission_color{1.0f, 1.0f, 1.0f};
  TextureSlot diffuse_transmission_color_texture;  ///< RGB sRGB
  Color sheen_color{0.0f, 0.0f, 0.0f};             ///< KHR_materials_sheen
  TextureSlot sheen_color_texture;                 ///< RGB sRGB
  float sheen_roughness = 0.0f;
  TextureSlot sheen_roughness_texture;  ///< A

  bool emits() const { return (emission > 0.0f).any(); }
  bool transmits() const { return transmission > 0.0f || diffuse_transmission > 0.0f; }
  /// Whether light enters an interior rather than passing an infinitely thin sheet.
  bool has_volume() const { return transmits() && thickness > 0.0f; }
  /// Whether its interior scatters light.
  bool scatters() const {
    return has_volume() && attenuation_distance < kInfinity && (multiscatter_color > 0.0f).any() &&
           (attenuation_color < 1.0f).any();
  }
  /// Whether it refracts colours at different angles. A thin sheet does not refract.
  bool disperses() const { return dispersion > 0.0f && transmission > 0.0f && thickness > 0.0f; }
};

/// A triangle list with one material, from one glTF primitive. Optional arrays are empty if the file has none
/// or the material does not read them; else they have one entry per position. Front faces are
/// counter-clockwise in the space of the mesh.
struct Mesh {
  std::string name;
  int material = -1;  ///< index into Scene::materials, always valid after loading
  /// The loader's index of a mesh whose vertices change over time; else -1.
  int deforming = -1;
  PaddedVector<Vec3> positions;
  std::vector<Vec3> normals;   ///< unit; empty means flat: the geometric normal of each triangle
  std::vector<Vec4> tangents;  ///< xyz unit, w the handedness (+1 or -1); present when a normal map or
                               ///< anisotropy needs them
  std::vector<Vec2> uv0;
  std::vector<Vec2> uv1;
  std::vector<Vec4> colors;  ///< COLOR_0, linear RGBA, multiplies the base colour
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A mesh in the world. Instances that share a mesh become Embree instances. A mesh with one instance holds
/// world-space vertices, and that instance has the identity transform (scene/bake.h).
struct Instance {
  std::string name;  ///< of the node, else of the mesh, else "node N" with its index in the file
  int mesh = -1;
  Affine transform = Affine::Identity();  ///< mesh to world
  bool baked = false;                     ///< the mesh is in world space and no other instance uses it
  bool moves = false;                     ///< its transform or vertices change over time; never baked
  bool hidden = false;                    ///< invisible at this time
  bool swaps_handedness = false;          ///< determinant < 0: front faces are clockwise in the mesh
  /// The same number for all instances of one placed glTF mesh (one for each of its primitives). Numbers
  /// increase in the order in which nodes are visited.
  int placement = -1;
  /// Where dielectric bodies overlap, the one with the highest priority fills the space
  /// (scene/nested_volumes.h).
  float dielectric_priority = 0.0f;
  Visibility visibility;
  LightLink link;  ///< of its emission
};

enum class LightType : std::uint8_t { directional, point, spot };

/// KHR_lights_punctual. Intensities are taken as radiometric numbers.
struct PunctualLight {
  std::string name;
  LightType type = LightType::point;
  Color intensity{1.0f, 1.0f,
                  1.0f};  ///< colour times intensity: W/sr (point, spot) or W/m2 facing it (directional)
  Vec3 position = Vec3::Zero();       ///< world; not for directional
  Vec3 direction{0.0f, 0.0f, -1.0f};  ///< world, unit: the direction in which light travels; not for point
  float range = kInfinity;            ///< metres; the extension's window function is 0 beyond it
  float cos_inner = 1.0f;             ///< spot: cosine of the inner cone angle
  float cos_outer = 0.70710678f;      ///< spot: cosine of the outer cone angle
  /// Only for point lights; `intensity` is then that of the brightest direction. `direction` is the axis of
  /// the profile and `side` its x axis (world, unit, perpendicular).
  std::shared_ptr<const IesProfile> profile;
  Vec3 side{1.0f, 0.0f, 0.0f};
  RayKinds rays = kAllRays;  ///< only kBounceRays matter: light that these kinds of rays would find
  LightLink link;
};

/// EXT_lights_image_based: infinitely distant light, as the six faces of a cube map.
struct ImageBasedLight {
  std::string name;
  /// +x, -x, +y, -y, +z, -z, as seen from inside the cube. Up is +y, but -z for the face +y and +z for the
  /// face -y. sRGB; if there is an alpha channel, linear colours are divided by it (RGBD).
  std::array<Image, 6> faces;
  float intensity = 1.0f;                                  ///< multiplies the faces
  Eigen::Matrix3f rotation = Eigen::Matrix3f::Identity();  ///< from the cube to the world
};

/// A camera that looks along -z of its transform, with y up.
struct Camera {
  std::string name;  ///< of the camera, else of its node
  std::string node;
  Affine transform = Affine::Identity();  ///< camera to world, without scale
  bool orthographic = false;
  float vertical_fov = 0.8f;  ///< radians; perspective
  float aspect = 0.0f;        ///< width over height; 0 means the picture's aspect
  float half_height = 1.0f;   ///< metres (ymag); orthographic
  float half_width = 0.0f;    ///< metres (xmag); orthographic; 0 means half_height times the picture's aspect
};

/// An animation of the file. LoadOptions::time says which moment the scene shows.
struct Animation {
  std::string name;
  double seconds = 0.0;  ///< time of its last key as declared in the file; 0 without keys
};

/// The parts of the scene, besides the cameras, that change over time (SceneFile::show()).
struct SceneMotion {
  bool instances = false;  ///< transforms, vertices or visibility
  bool lights = false;
  bool image_light = false;
  bool materials = false;

  bool any() const { return instances || lights || image_light || materials; }
};

/// The vertices of a deforming mesh at one time; see Mesh.
struct DeformedVertices {
  PaddedVector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec4> tangents;

  friend bool operator==(const DeformedVertices&, const DeformedVertices&) = default;
};

/// Position and orientation of a punctual light at one time; see PunctualLight.
struct LightPlace {
  Vec3 position = Vec3::Zero();
  Vec3 direction{0.0f, 0.0f, -1.0f};
  Vec3 side{1.0f, 0.0f, 0.0f};

  friend bool operator==(const LightPlace&, const LightPlace&) = default;
};

/// Motion while the shutter is open. Lists have the scene's indices; an entry holds the states at two or more
/// evenly spaced times from opening to closing, between which it changes linearly (scene/shutter.h). The
/// entry of a static object is empty. The scene itself shows the middle of the exposure.
struct ShutterMotion {
  /// The shutter time of each state, from 0 to 1, with 0.5 in the middle. Two equal times mark a jump. Empty
  /// if the states are evenly spaced in time.
  std::vector<float> clock;
  std::vector<std::vector<Affine>> transforms;          ///< of instances
  std::vector<std::vector<DeformedVertices>> vertices;  ///< of meshes
  std::vector<std::vector<LightPlace>> lights;
  std::vector<std::vector<Camera>> cameras;
  bool is_open = false;    ///< else all lists are empty
  bool instances = false;  ///< some transforms or vertices change
};

struct Scene {
  std::string path;  ///< the loaded file
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Instance> instances;
  std::vector<PunctualLight> lights;
  std::optional<ImageBasedLight> image_light;
  /// Who sees the environment and the sky, whether they are the file's or not: camera rays see them as the
  /// background, bounces and shadow rays as light.
  RayKinds environment_rays = kAllRays;
  LightLink environment_link;
  std::vector<ObjectSet> object_sets;
  std::vector<std::string> dark_lights;  ///< names of emissive materials that adjust_lights() made black
  std::vector<Camera> cameras;
  std::vector<std::string> variants;  ///< names of KHR_materials_variants
  std::vector<Animation> animations;  ///< all of the file, even if not evaluated
  SceneMotion motion;
  ShutterMotion shutter;
  std::vector<std::string> warnings;  ///< one line each, without duplicates
  /// In world space; empty if there are no triangles. In animated scenes, the bounds of the static pose, so
  /// that choices that depend on the scene's size are the same at all times.
  Box bounds;
  /// Position of the world's origin in the file's coordinates. It is not zero for a scene that lies far from
  /// the file's origin, compared with its size: single precision would lose too many digits there
  /// (kFarFromOrigin in scene/gltf.h).
  Vec3 origin = Vec3::Zero();
  /// Where its objects look: 1 along +z, -1 along -z, as avatars of VRM 0 do. For views of files without a
  /// camera.
  float front = 1.0f;

  const Mesh& mesh_of(const Instance& instance) const {
    return meshes[static_cast<std::size_t>(instance.mesh)];
  }
  const Material& material_of(const Instance& instance) const {
    return materials[static_cast<std::size_t>(mesh_of(instance).material)];
  }
};

/// The corners of a triangle in world space, in the mesh's order.
std::array<Vec3, 3> world_triangle(const Scene& scene, const Instance& instance, std::uint32_t primitive);

/// Unit normal of a triangle's front face in world space, also for mirrored instances; zero if the corners
/// lie on a line.
Vec3 world_normal(const Scene& scene, const Instance& instance, std::uint32_t primitive);

/// Area of a triangle in world space, square metres.
double world_area(const Scene& scene, const Instance& instance, std::uint32_t primitive);

/// Number of triangles, counted once per instance.
std::size_t count_triangles(const Scene& scene);

/// Bytes of all vertices and indices, and of all decoded images.
std::size_t geometry_bytes(const Scene& scene);
std::size_t image_bytes(const Scene& scene);

}  // namespace gatelight::scene
