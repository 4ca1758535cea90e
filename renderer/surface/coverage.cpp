#include "renderer/surface/coverage.h"

#include "renderer/sampling/sampler.h"
#include "renderer/surface/interpolate.h"
#include "renderer/surface/read_film.h"

namespace gatelight::renderer {
namespace {

/// Reads textures at a hit, at the finest level.
struct FinestLevel {
  const Textures& textures;
  const scene::Mesh& mesh;
  const Corners& corners;
  Vec3 weights;

  FinestLevel(const Textures& all, const scene::Mesh& hit_mesh, const Hit& hit)
      : textures(all),
        mesh(hit_mesh),
        corners(mesh.triangles[hit.primitive]),
        weights(1.0f - hit.u - hit.v, hit.u, hit.v) {}

  /// Returns one where there is no texture.
  Vec4 operator()(const scene::TextureSlot& slot, Encoding encoding) const {
    if (!slot) return Vec4::Ones();
    return textures.lookup(slot, encoding, uv_at(mesh, slot, corners, weights), 0.0f, 0.0f);
  }
  Vec4 vertex_color() const {
    return mesh.colors.empty() ? Vec4(Vec4::Ones()) : interpolate(mesh.colors, corners, weights);
  }
};

}  // namespace

void remove_refraction(SurfaceMaterial& material) {
  material.thin_walled = true;
  material.roughness = 0.0f;
  material.clearcoat = 0.0f;
  material.anisotropy = 0.0f;
  material.sheen_color.setZero();
}

Coverage::Coverage(const scene::Scene& scene, const Textures& textures, const Media& media,
                   bool unrefracted_glass)
    : scene_(scene), textures_(textures), media_(media), unrefracted_glass_(unrefracted_glass) {
  flags_.resize(scene.instances.size(), 0);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Material& m = scene.material_of(scene.instances[i]);
    if (m.alpha_mode != scene::AlphaMode::opaque) flags_[i] |= kAlpha;
    if (m.culled) flags_[i] |= kCulled;
    const bool smooth =
        m.roughness == 0.0f || (m.roughness < kDeltaRoughness && !m.metallic_roughness_texture);
    const bool plain = m.clearcoat == 0.0f && m.anisotropy == 0.0f && (m.sheen_color == 0.0f).all();
    if (m.transmission > 0.0f && !m.has_volume() && smooth && plain) flags_[i] |= kPane;
    if (m.transmission > 0.0f && m.has_volume() && unrefracted_glass) flags_[i] |= kUnrefractedGlass;
  }
}

float Coverage::alpha(const Hit& hit, const scene::Material& m) const {
  const FinestLevel read(textures_, scene_.mesh_of(scene_.instances[hit.instance]), hit);
  return m.base_alpha * read(m.base_color_texture, Encoding::srgb).w() * read.vertex_color().w();
}

bool Coverage::is_there(const Hit& hit, std::uint32_t seed) const {
  const scene::Material& m = scene_.material_of(scene_.instances[hit.instance]);
  if (seed == kMeetsAll && m.alpha_mode == scene::AlphaMode::blend) return true;
  const float a = alpha(hit, m);
  if (m.alpha_mode == scene::AlphaMode::mask) return a >= m.alpha_cutoff;
  const std::uint32_t surface = hash(hit.primitive ^ hash(hit.instance + 0x9e3779b9u));
  return alpha_number(seed, surface) < a;
}

Passage Coverage::pass(const Hit& hit, const Vec3& direction, const MediumStack& around) const {
  Passage passage;
  if (!(flags_[hit.instance] & (kPane | kUnrefractedGlass))) return passage;
  const scene::Instance& instance = scene_.instances[hit.instance];
  const scene::Material& m = scene_.material_of(instance);
  const FinestLevel read(textures_, scene_.mesh_of(instance), hit);
  SurfaceMaterial s;
  s.roughness = m.roughness;
  s.base_color = m.base_color * read(m.base_color_texture, Encoding::srgb).head<3>().array() *
                 read.vertex_color().head<3>().array();
  s.ior = m.ior;
  s.specular = m.specular;
  s.specular_color = m.specular_color;
  read_film(m, read, s);
  s.metallic = m.metallic * read(m.metallic_roughness_texture, Encoding::linear).z();
  s.transmission = m.transmission * read(m.transmission_texture, Encoding::linear).x();
  const Vec3 n = scene::world_normal(scene_, instance, hit.primitive);
  const bool front = passage.front = n.dot(direction) < 0.0f;
  if (is_unrefracted_glass(hit.instance)) {
    const std::uint32_t volume = media_.volume_of(hit.instance);
    if (!media_.is_there(volume, around)) {
      passage.transmittance.setConstant(glass_share(s));
      return passage;
    }
    s.ior /= media_.beyond(volume, around).ior;
    remove_refraction(s);
    if (volume == scene::kNoVolume) passage.absorption = front ? extinction_of(m) : Color(-extinction_of(m));
  }
  const Vec3 facing = front ? n : Vec3(-n);
  passage.transmittance = Bsdf(s, facing, facing, facing, -direction, front).unrefracted_transmittance();
  return passage;
}

}  // namespace gatelight::renderer
