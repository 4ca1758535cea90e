#include "renderer/surface/coverage.h"

#include "renderer/bsdf/bsdf.h"

namespace gatelight::renderer {

namespace {

template <typename T>
T interpolate(const std::vector<T>& values, const std::array<std::uint32_t, 3>& corner, float u, float v) {
  return values[corner[0]] * (1.0f - u - v) + values[corner[1]] * u + values[corner[2]] * v;
}

Vec2 texcoord(const scene::Mesh& mesh, const scene::TextureSlot& slot, const Hit& hit) {
  const std::vector<Vec2>& uv = slot.texcoord == 1 ? mesh.uv1 : mesh.uv0;
  return uv.empty() ? Vec2(0.0f, 0.0f) : interpolate(uv, mesh.triangles[hit.primitive], hit.u, hit.v);
}

}  // namespace

Coverage::Coverage(const scene::Scene& scene, const Textures& textures) : scene_(scene), textures_(textures) {
  flags_.resize(scene.instances.size(), 0);
  for (std::size_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Material& m = scene.material_of(scene.instances[i]);
    if (m.alpha_mode != scene::AlphaMode::opaque) flags_[i] |= kAlpha;
    const bool smooth =
        m.roughness == 0.0f || (m.roughness < Bsdf::kDeltaRoughness && !m.metallic_roughness_texture);
    const bool plain = m.clearcoat == 0.0f && (m.sheen_color == 0.0f).all();
    if (m.transmits() && !m.has_volume() && smooth && plain) flags_[i] |= kPane;
  }
}

float Coverage::alpha(const Hit& hit) const {
  const scene::Instance& instance = scene_.instances[hit.instance];
  const scene::Mesh& mesh = scene_.mesh_of(instance);
  const scene::Material& m = scene_.material_of(instance);
  float alpha = m.base_alpha;
  if (m.base_color_texture) {
    alpha *= textures_
                 .lookup(m.base_color_texture, Encoding::srgb, texcoord(mesh, m.base_color_texture, hit),
                         0.0f, 0.0f)
                 .w();
  }
  if (!mesh.colors.empty())
    alpha *= interpolate(mesh.colors, mesh.triangles[hit.primitive], hit.u, hit.v).w();
  return alpha;
}

bool Coverage::is_there(const Hit& hit, std::uint32_t seed) const {
  const scene::Material& m = scene_.material_of(scene_.instances[hit.instance]);
  const float a = alpha(hit);
  if (m.alpha_mode == scene::AlphaMode::mask) return a >= m.alpha_cutoff;
  const std::uint32_t h = hash(seed ^ hash(hit.primitive ^ hash(hit.instance + 0x9e3779b9u)));
  return static_cast<float>(h >> 8) * 0x1p-24f < a;
}

Color Coverage::pane_transmittance(const Hit& hit, const Vec3& direction) const {
  if (!(flags_[hit.instance] & kPane)) return Color::Zero();
  const scene::Instance& instance = scene_.instances[hit.instance];
  const scene::Mesh& mesh = scene_.mesh_of(instance);
  const scene::Material& m = scene_.material_of(instance);
  SurfaceMaterial s;
  s.roughness = m.roughness;
  s.base_color = m.base_color;
  s.ior = m.ior;
  s.specular = m.specular;
  s.specular_color = m.specular_color;
  s.metallic = m.metallic;
  s.transmission = m.transmission;
  if (m.base_color_texture) {
    s.base_color *= textures_
                        .lookup(m.base_color_texture, Encoding::srgb,
                                texcoord(mesh, m.base_color_texture, hit), 0.0f, 0.0f)
                        .head<3>()
                        .array();
  }
  if (!mesh.colors.empty()) {
    s.base_color *= interpolate(mesh.colors, mesh.triangles[hit.primitive], hit.u, hit.v).head<3>().array();
  }
  if (m.metallic_roughness_texture) {
    s.metallic *= textures_
                      .lookup(m.metallic_roughness_texture, Encoding::linear,
                              texcoord(mesh, m.metallic_roughness_texture, hit), 0.0f, 0.0f)
                      .z();
  }
  if (m.transmission_texture) {
    s.transmission *= textures_
                          .lookup(m.transmission_texture, Encoding::linear,
                                  texcoord(mesh, m.transmission_texture, hit), 0.0f, 0.0f)
                          .x();
  }
  const Vec3 n = scene::world_normal(scene_, instance, hit.primitive);
  const bool front = n.dot(direction) < 0.0f;
  const Vec3 facing = front ? n : Vec3(-n);
  return Bsdf(s, facing, facing, facing, -direction, front).straight_transmittance();
}

}  // namespace gatelight::renderer
