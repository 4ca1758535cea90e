#include "renderer/surface/shadow_transmittance.h"

#include <algorithm>
#include <span>
#include <tuple>

namespace gatelight::renderer {

void ShadowTransmittance::start(const Ray& ray) {
  seed = ray.seed;
  origin_ = ray.origin;
  direction_ = ray.direction;
  transmittance_ = Color::Ones();
  if (absorbed_) {
    depth_.setZero();
    inside_.setZero();
    absorbed_ = false;
  }
  panes_ = boundary_count_ = 0;
  start_ = ray.inside;
}

bool ShadowTransmittance::pass(const Coverage& coverage, const Hit& hit) {
  const Passage passage = coverage.pass(hit, direction_);
  if ((passage.transmittance <= 0.0f).all()) return false;
  const std::uint64_t id = static_cast<std::uint64_t>(hit.instance) << 32 | hit.primitive;
  if (std::find(met_, met_ + panes_, id) != met_ + panes_) return true;
  if (panes_ == kMaxPanes) return false;
  met_[panes_++] = id;
  if (coverage.orders(hit.instance)) {
    const std::uint32_t volume = coverage.media().volume_of(hit.instance);
    boundaries_[boundary_count_++] = {hit.t,         hit.u,  hit.v,        hit.instance,
                                      hit.primitive, volume, passage.front};
    return true;
  }
  transmittance_ *= passage.transmittance;
  if ((passage.absorption == 0.0f).all()) return true;
  absorbed_ = true;
  depth_ -= passage.absorption * hit.t;
  inside_ += passage.absorption;
  return true;
}

Color ShadowTransmittance::passed(const Coverage& coverage, float distance) {
  const Color nested = boundary_count_ > 0 ? through_boundaries(coverage, distance) : Color(Color::Ones());
  // Boundaries of volumes tell what the ray starts in.
  const ScatteringMedium* const start = boundary_count_ == 0 ? start_ : nullptr;
  if (!absorbed_ && !start) return transmittance_ * nested;
  Color all = depth_, inside = inside_;
  if (start && start->box) {
    all += start->extinction * start->within(origin_, direction_, distance).length();
  } else if (start) {
    inside += start->extinction;
  }
  if (distance < kInfinity) all += inside.max(0.0f) * distance;
  return transmittance_ * nested * (-all.max(0.0f)).exp();
}

/// The effect of a boundary depends on the volumes around the ray, so boundaries are passed in their order.
[[gnu::noinline, gnu::cold]] Color ShadowTransmittance::through_boundaries(const Coverage& coverage,
                                                                           float distance) {
  const std::span<Boundary> all(boundaries_, static_cast<std::size_t>(boundary_count_));
  std::sort(all.begin(), all.end(), [](const Boundary& a, const Boundary& b) {
    return std::tuple(a.t, a.instance, a.primitive) < std::tuple(b.t, b.instance, b.primitive);
  });
  // The ray starts in the volumes whose first boundary it leaves.
  MediumStack in;
  for (auto b = all.begin(); b != all.end(); ++b) {
    const bool first = std::none_of(all.begin(), b, [&](const Boundary& a) { return a.volume == b->volume; });
    if (first && !b->front && b->volume != scene::kNoVolume) in.enter(b->volume);
  }
  const Media& media = coverage.media();
  const auto extinction = [](const ScatteringMedium* inside) {
    return inside ? inside->extinction : Color(Color::Zero());
  };
  const ScatteringMedium* inside = media.of(in.strongest()).inside;
  Color light = Color::Ones(), absorption = Color::Zero(), here = extinction(inside);
  float at = 0.0f;
  const auto end_at = [&](float t) {
    absorption += here * (inside ? inside->within(origin_, direction_, t).after(at) : t - at);
  };
  for (const Boundary& b : all) {
    const Passage passage = coverage.pass(b.hit(), direction_, in);
    if (at == 0.0f && b.volume == scene::kNoVolume && !b.front) here = -passage.absorption;
    end_at(b.t);
    at = b.t;
    light *= passage.transmittance;
    inside = cross(media, in, b.volume, b.front, b.instance, coverage.material_of(b.instance)).medium;
    here = extinction(inside);
  }
  if (distance < kInfinity || (inside && inside->box)) end_at(distance);
  return light * (-absorption).exp();
}

}  // namespace gatelight::renderer
