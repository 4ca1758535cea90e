#include "renderer/surface/surface.h"

#include <algorithm>
#include <cmath>

#include "renderer/surface/interpolate.h"
#include "renderer/surface/read_film.h"
#include "renderer/surface/shadow_terminator.h"
#include "scene/triangle_normal.h"

namespace gatelight::renderer {

namespace {

/// Reads the textures of one material at one point.
class Reader {
 public:
  Reader(const Textures& textures, const scene::Mesh& mesh, const Corners& corners, const Vec3& b,
         float footprint_world, float area_world, float u_level)
      : textures_(textures), u_level_(u_level) {
    const std::vector<Vec2>* sets[2] = {&mesh.uv0, &mesh.uv1};
    for (int s = 0; s < 2; ++s) {
      if (sets[s]->empty()) continue;
      uv_[s] = interpolate(*sets[s], corners, b);
      const Vec2 e1 = (*sets[s])[corners[1]] - (*sets[s])[corners[0]];
      const Vec2 e2 = (*sets[s])[corners[2]] - (*sets[s])[corners[0]];
      const float area_uv = std::abs(e1.x() * e2.y() - e1.y() * e2.x());
      footprint_[s] = area_world > 0.0f ? footprint_world * std::sqrt(area_uv / area_world) : 0.0f;
    }
  }

  Vec4 operator()(const scene::TextureSlot& slot, Encoding encoding) const {
    const int set = slot.texcoord == 1 ? 1 : 0;
    return textures_.lookup(slot, encoding, uv_[set], footprint_[set], u_level_);
  }
  Color color(const scene::TextureSlot& slot) const {
    return (*this)(slot, Encoding::srgb).head<3>().array();
  }
  /// Always reads the finest level, because next-event estimation samples that level.
  Color emission(const scene::TextureSlot& slot) const {
    return textures_.lookup(slot, Encoding::srgb, uv_[slot.texcoord == 1 ? 1 : 0], 0.0f, 0.0f)
        .head<3>()
        .array();
  }

 private:
  const Textures& textures_;
  float u_level_;
  Vec2 uv_[2] = {Vec2::Zero(), Vec2::Zero()};
  float footprint_[2] = {0.0f, 0.0f};
};

/// A tangent frame around a normal. Degenerate where the tangent is parallel to the normal.
class Frame {
 public:
  /// `tangent`: w is the handedness; flip: the bitangent belongs to the frame of the file's normal, and a
  /// turned normal turns the whole frame.
  Frame(const Vec3& n, const Vec4& tangent, bool flip) : n_(n), t_(tangent.head<3>()) {
    t_ -= n * n.dot(t_);
    const float length = t_.squaredNorm();
    degenerate_ = !(length > 1e-12f);
    if (degenerate_) return;
    t_ /= std::sqrt(length);
    bitangent_ = n.cross(t_) * (flip ? -tangent.w() : tangent.w());
  }

  /// The normal of a texel in world space; the frame's own where the map or the frame is degenerate.
  Vec3 mapped_normal(const Vec4& texel, float scale) const {
    const Vec3 m((texel.x() * 2.0f - 1.0f) * scale, (texel.y() * 2.0f - 1.0f) * scale,
                 texel.z() * 2.0f - 1.0f);
    if (degenerate_) return n_;
    const Vec3 mapped = t_ * m.x() + bitangent_ * m.y() + n_ * m.z();
    const float squared = mapped.squaredNorm();
    if (!(squared > 1e-12f)) return n_;
    return mapped / std::sqrt(squared);
  }

  /// The direction of greater roughness in world space, from its components along tangent and bitangent and
  /// a rotation in radians; zero where there is none.
  Vec3 anisotropy_direction(const Vec2& components, float rotation) const {
    if (degenerate_ || !(components.squaredNorm() > 1e-6f)) return Vec3::Zero();
    const float c = std::cos(rotation), s = std::sin(rotation);
    const Vec2 turned(c * components.x() - s * components.y(), s * components.x() + c * components.y());
    return (t_ * turned.x() + bitangent_ * turned.y()).normalized();
  }

 private:
  Vec3 n_;
  Vec3 t_;
  Vec3 bitangent_ = Vec3::Zero();
  bool degenerate_ = false;
};

/// Moves a point of a flat triangle onto the round surface that the normals of its corners describe.
void offset_shadow_terminator(Surface& s, const Vec3 (&p)[3], const Vec3 (&n)[3], const Vec3& weights,
                              const Vec3& wo) {
  // A smooth normal that is further from the triangle's comes from a file whose normals are wrong.
  constexpr float kMinRaiseCosine = 0.1f;
  const float cosine = s.smooth_normal.dot(s.geometric_normal);
  const Vec3 raise = terminator_raise(s.position, p, n, weights);
  if (!(raise.dot(s.geometric_normal) > s.offset && cosine > kMinRaiseCosine &&
        s.smooth_normal.dot(wo) > 0.0f)) {
    return;
  }
  s.position += raise;
  s.geometric_normal = s.smooth_normal;
  s.offset /= cosine;
}

void read_metallic_roughness(const scene::Material& m, const Reader& read, SurfaceMaterial& material) {
  material.metallic = m.metallic;
  material.roughness = m.roughness;
  if (m.metallic_roughness_texture) {
    const Vec4 t = read(m.metallic_roughness_texture, Encoding::linear);
    material.roughness *= t.y();
    material.metallic *= t.z();
  }
  if (m.glossiness_texture) {
    const float glossiness = read(m.glossiness_texture, Encoding::srgb).w();
    material.roughness = 1.0f - (1.0f - material.roughness) * glossiness;
  }
  material.ior = m.ior;
  material.specular = m.specular;
  material.specular_color = m.specular_color;
  if (m.specular_texture) material.specular *= read(m.specular_texture, Encoding::linear).w();
  if (m.specular_color_texture) material.specular_color *= read.color(m.specular_color_texture);
}

void read_transmission(const scene::Material& m, const Reader& read, SurfaceMaterial& material) {
  if (m.transmits()) {
    material.thin_walled = !m.has_volume();
    if (m.disperses()) material.dispersion = m.dispersion;
    material.transmission = m.transmission;
    if (m.transmission_texture) material.transmission *= read(m.transmission_texture, Encoding::linear).x();
  }
  read_film(m, read, material);
  if (!(m.diffuse_transmission > 0.0f)) return;
  material.diffuse_transmission = m.diffuse_transmission;
  material.diffuse_transmission_color = m.diffuse_transmission_color;
  if (m.diffuse_transmission_texture)
    material.diffuse_transmission *= read(m.diffuse_transmission_texture, Encoding::linear).w();
  if (m.diffuse_transmission_color_texture)
    material.diffuse_transmission_color *= read.color(m.diffuse_transmission_color_texture);
}

void read_sheen(const scene::Material& m, const Reader& read, SurfaceMaterial& material) {
  if (!(m.sheen_color > 0.0f).any()) return;
  material.sheen_color = m.sheen_color;
  material.sheen_roughness = m.sheen_roughness;
  if (m.sheen_color_texture) material.sheen_color *= read.color(m.sheen_color_texture);
  if (m.sheen_roughness_texture)
    material.sheen_roughness *= read(m.sheen_roughness_texture, Encoding::linear).w();
}

void read_clearcoat(const scene::Material& m, const Reader& read, SurfaceMaterial& material) {
  if (!(m.clearcoat > 0.0f)) return;
  material.clearcoat = m.clearcoat;
  material.clearcoat_roughness = m.clearcoat_roughness;
  if (m.clearcoat_texture) material.clearcoat *= read(m.clearcoat_texture, Encoding::linear).x();
  if (m.clearcoat_roughness_texture)
    material.clearcoat_roughness *= read(m.clearcoat_roughness_texture, Encoding::linear).y();
}

/// Normal maps, and the direction of anisotropy.
void read_frame(const scene::Material& m, const Reader& read, const Frame& frame, Surface& s) {
  if (m.normal_texture)
    s.shading_normal = frame.mapped_normal(read(m.normal_texture, Encoding::linear), m.normal_scale);
  if (m.anisotropy > 0.0f) {
    Vec3 texel(1.0f, 0.0f, 1.0f);
    if (m.anisotropy_texture) {
      texel = read(m.anisotropy_texture, Encoding::linear).head<3>();
      texel.head<2>() = 2.0f * texel.head<2>() - Vec2::Ones();
    }
    s.material.anisotropy_direction = frame.anisotropy_direction(texel.head<2>(), m.anisotropy_rotation);
    if (!s.material.anisotropy_direction.isZero(0.0f)) s.material.anisotropy = m.anisotropy * texel.z();
  }
  if (m.clearcoat > 0.0f && m.clearcoat_normal_texture) {
    s.coat_normal =
        frame.mapped_normal(read(m.clearcoat_normal_texture, Encoding::linear), m.clearcoat_normal_scale);
  }
}

}  // namespace

Surfaces::Surfaces(const scene::Scene& scene, const Textures& textures) : textures_(textures) {
  views_.resize(scene.instances.size());
  for (std::size_t i = 0; i < views_.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    View& view = views_[i];
    view.mesh = &scene.mesh_of(instance);
    view.material = &scene.material_of(instance);
    view.baked = instance.baked;
    view.swaps_handedness = instance.swaps_handedness;
    if (!instance.baked) {
      view.transform = instance.transform;
      view.normal_matrix = normal_matrix(instance.transform);
      view.rounding = PlacementRounding(scene, i);
    }
    if (!scene.shutter.instances) continue;
    const auto& vertices = scene.shutter.vertices[static_cast<std::size_t>(instance.mesh)];
    if (!vertices.empty()) view.vertices = &vertices;
    if (!scene.shutter.transforms[i].empty()) view.transforms = &scene.shutter.transforms[i];
  }
}

Surfaces::View Surfaces::View::at(float shutter_time) const {
  View moved = *this;
  moved.time = shutter_time;
  if (transforms) {
    moved.transform = scene::transform_at(*transforms, shutter_time);
    moved.normal_matrix = gatelight::normal_matrix(moved.transform);
  }
  return moved;
}

Vec3 Surfaces::View::position(std::uint32_t vertex) const {
  return vertices ? scene::attribute_at(*vertices, time, vertex, &scene::DeformedVertices::positions)
                  : mesh->positions[vertex];
}

Vec3 Surfaces::View::normal(std::uint32_t vertex) const {
  return vertices ? scene::attribute_at(*vertices, time, vertex, &scene::DeformedVertices::normals)
                  : mesh->normals[vertex];
}

Vec4 Surfaces::View::tangent(std::uint32_t vertex) const {
  return vertices ? scene::attribute_at(*vertices, time, vertex, &scene::DeformedVertices::tangents)
                  : mesh->tangents[vertex];
}

Vec3 Surfaces::View::world_normal(const Vec3& normal, bool turn) const {
  Vec3 n = baked ? normal : Vec3(normal_matrix * normal);
  const float squared = n.squaredNorm();
  if (squared > 0.0f) n /= turn ? -std::sqrt(squared) : std::sqrt(squared);
  return n;
}

void Surfaces::prefetch_vertices(const Hit& hit) const {
  if (!hit) return;
  const scene::Mesh& mesh = *views_[hit.instance].mesh;
  for (const std::uint32_t corner : mesh.triangles[hit.primitive]) {
    __builtin_prefetch(&mesh.positions[corner]);
    if (!mesh.normals.empty()) __builtin_prefetch(&mesh.normals[corner]);
    if (!mesh.uv0.empty()) __builtin_prefetch(&mesh.uv0[corner]);
    if (!mesh.tangents.empty()) __builtin_prefetch(&mesh.tangents[corner]);
  }
}

/// The place of a hit on its triangle, in world space.
struct Surfaces::Place {
  Vec3 b;               ///< barycentric coordinates
  Vec3 corners[3];      ///< positions
  Vec3 normal;          ///< of the triangle, by its winding
  float area = 0.0f;    ///< twice the area
  bool turned = false;  ///< the file's normal contradicts the winding
};

Surfaces::Place Surfaces::place(const View& view, const Hit& hit, const Vec3& direction, Surface& s) {
  const scene::Mesh& mesh = *view.mesh;
  const Corners& corners = mesh.triangles[hit.primitive];
  Place place;
  place.b = Vec3(1.0f - hit.u - hit.v, hit.u, hit.v);
  const Vec3& b = place.b;
  Vec3(&p)[3] = place.corners;
  for (int corner = 0; corner < 3; ++corner) {
    p[corner] = view.position(corners[corner]);
    if (!view.baked) p[corner] = view.transform * p[corner];
  }
  Vec3& ng = place.normal;
  ng = scene::triangle_normal(p[0], p[1], p[2], place.area);
  if (!(place.area > 0.0f)) ng = -direction;
  s.position = p[0] * b.x() + p[1] * b.y() + p[2] * b.z();
  s.offset = rounding_offset(p[0], p[1], p[2], view.rounding);

  if (view.swaps_handedness) ng = -ng;
  s.front = ng.dot(direction) <= 0.0f;
  Vec3 ns = ng;
  if (!mesh.normals.empty()) {
    Vec3 n =
        view.normal(corners[0]) * b.x() + view.normal(corners[1]) * b.y() + view.normal(corners[2]) * b.z();
    if (!view.baked) n = view.normal_matrix * n;
    const float squared = n.squaredNorm();
    if (squared > 0.0f) ns = n / std::sqrt(squared);
  }
  s.geometric_normal = s.front ? ng : Vec3(-ng);
  // The side of the geometric normal decides.
  place.turned = ns.dot(s.geometric_normal) < 0.0f;
  s.smooth_normal = place.turned ? Vec3(-ns) : ns;
  s.shading_normal = s.smooth_normal;
  s.coat_normal = s.smooth_normal;
  if (!mesh.normals.empty() && !view.material->transmits()) {
    Vec3 n[3];
    for (int corner = 0; corner < 3; ++corner)
      n[corner] = view.world_normal(view.normal(corners[corner]), place.turned);
    offset_shadow_terminator(s, p, n, b, -direction);
  }
  return place;
}

Surface Surfaces::at(const Hit& hit, const Vec3& direction, float cone_width, float u_level) const {
  const View& view = views_[hit.instance];
  return view.is_blurred() ? at(view.at(hit.time), hit, direction, cone_width, u_level)
                           : at(view, hit, direction, cone_width, u_level);
}

Surface Surfaces::at(const Hit& hit, const Vec3& direction, float cone_width, float u_level,
                     const scene::Material& material) const {
  View view = views_[hit.instance].at(hit.time);
  view.material = &material;
  return at(view, hit, direction, cone_width, u_level);
}

Surface Surfaces::at(const View& view, const Hit& hit, const Vec3& direction, float cone_width,
                     float u_level) const {
  const scene::Mesh& mesh = *view.mesh;
  const scene::Material& m = *view.material;
  const Corners& corners = mesh.triangles[hit.primitive];
  Surface s;
  const Place place = Surfaces::place(view, hit, direction, s);
  const float cosine = std::abs(place.normal.dot(direction));
  // The short side of the footprint is the cone's width, the long side is width / cosine. This is their
  // geometric mean.
  const Reader read(textures_, mesh, corners, place.b, cone_width / std::sqrt(std::max(cosine, 0.01f)),
                    place.area, u_level);

  Color base = m.base_color;
  if (m.base_color_texture) base *= read.color(m.base_color_texture);
  if (!mesh.colors.empty()) base *= interpolate(mesh.colors, corners, place.b).head<3>().array();
  s.material.base_color = base.max(0.0f).min(1.0f);
  if (m.unlit) {
    s.unlit = true;
    s.emission = base;
    return s;
  }
  if (m.emits() && (s.front || m.double_sided)) {
    s.emission = m.emission;
    if (m.emission_texture) s.emission *= read.emission(m.emission_texture);
  }
  read_metallic_roughness(m, read, s.material);
  read_transmission(m, read, s.material);
  read_sheen(m, read, s.material);
  const bool mapped_coat = m.clearcoat > 0.0f && m.clearcoat_normal_texture;
  if (!mesh.tangents.empty() && (m.normal_texture || m.anisotropy > 0.0f || mapped_coat)) {
    const Vec3& b = place.b;
    Vec4 tangent = view.tangent(corners[0]) * b.x() + view.tangent(corners[1]) * b.y() +
                   view.tangent(corners[2]) * b.z();
    tangent.w() = mesh.tangents[corners[0]].w();
    if (!view.baked) tangent.head<3>() = (view.transform.linear() * tangent.head<3>()).eval();
    read_frame(m, read, Frame(s.smooth_normal, tangent, place.turned != view.swaps_handedness), s);
  }
  read_clearcoat(m, read, s.material);
  return s;
}

}  // namespace gatelight::renderer
