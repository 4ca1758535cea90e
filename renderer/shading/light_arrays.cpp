#include "renderer/shading/light_arrays.h"

#include <algorithm>

namespace gatelight::renderer {
namespace {

void append(std::vector<float>& to, const auto& vector) {
  to.insert(to.end(), {vector.x(), vector.y(), vector.z()});
}

}  // namespace

LightArrays::LightArrays(const Lights& lights)
    : usable_(lights.tree() != nullptr && !lights.moves()), placed_tree_(lights.placed_tree()) {
  if (!usable_) return;
  view_.tree = lights.tree()->node_numbers();
  view_.nearest2 = lights.tree()->nearest2();

  const EmissiveTriangles& emissive = lights.triangles();
  view_.triangle_count = static_cast<std::uint32_t>(emissive.size());
  triangles_.reserve(emissive.size() * LightArraysPtr::kTriangleFloats);
  for (std::size_t i = 0; i < emissive.size(); ++i) {
    const EmissiveTriangle& t = emissive[i];
    complete_ = complete_ && t.plain;
    append(triangles_, t.corners.corner);
    append(triangles_, t.corners.edge1);
    append(triangles_, t.corners.edge2);
    append(triangles_, t.normal);
    triangles_.insert(triangles_.end(), {t.area, t.offset});
    append(triangles_, t.emission);
    triangles_.insert(triangles_.end(), {t.two_sided ? -1.0f : 1.0f, t.plain ? 0.0f : 1.0f, 0.0f});
  }
  for (const scene::PunctualLight& light : lights.placed()) {
    append(placed_, light.position);
    append(placed_, light.direction);
    append(placed_, light.intensity);
    const bool spot = light.type == scene::LightType::spot;
    placed_.insert(placed_.end(),
                   {1.0f / light.range, light.cos_outer, std::max(0.001f, light.cos_inner - light.cos_outer),
                    spot ? 1.0f : 0.0f, light.profile ? 1.0f : 0.0f, 0.0f, 0.0f});
    complete_ = complete_ && !light.profile;
  }
  for (const scene::PunctualLight& light : lights.distant()) {
    append(suns_, light.direction);
    append(suns_, light.intensity);
  }
  view_.triangles = triangles_.data();
  view_.placed = placed_.data();
  view_.placed_count = static_cast<std::uint32_t>(lights.placed().size());
  view_.suns = suns_.data();
  view_.sun_count = static_cast<std::uint32_t>(lights.distant().size());
  const Environment& sky = lights.environment();
  view_.always_sky = lights.samples_sky(true);
  if (lights.samples_sky(false)) view_.sky = sky.constant() ? LightArraysPtr::Sky::constant : LightArraysPtr::Sky::picture;
  complete_ = complete_ && view_.sky != LightArraysPtr::Sky::picture;
  for (int c = 0; c < 3; ++c) view_.sky_radiance[c] = sky.mean()[c];
}

LightArraysPtr LightArrays::delta_view() const {
  LightArraysPtr view = view_;
  view.tree = placed_tree_->node_numbers();
  view.nearest2 = placed_tree_->nearest2();
  view.triangle_count = 0;
  view.sky = LightArraysPtr::Sky::none;
  view.always_sky = false;
  return view;
}

}  // namespace gatelight::renderer
