#include "bench/bare_embree.h"

#include <benchmark/benchmark.h>

#include <algorithm>

namespace gatelight::bench {

BareEmbree::BareEmbree(const scene::Scene& scene, Watertight watertight)
    : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
  rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_HIGH);
  rtcSetSceneFlags(scene_, watertight == Watertight::robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  for (const scene::Instance& instance : scene.instances) {
    const scene::Mesh& mesh = scene.mesh_of(instance);
    if (mesh.triangles.empty()) continue;
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<Vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3), mesh.positions.size()));
    for (const Vec3& p : mesh.positions) *positions++ = instance.baked ? p : Vec3(instance.transform * p);
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(mesh.triangles[0]), mesh.triangles.size()));
    for (const auto& t : mesh.triangles) indices = std::copy(t.begin(), t.end(), indices);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_);
}

BareEmbree::~BareEmbree() {
  rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

void BareEmbree::trace_single(std::span<const renderer::Ray> rays, bool shadow) const {
  renderer::EmbreeQuery query(false);
  for (const renderer::Ray& r : rays) {
    RTCRayHit ray = to_embree(r.origin, r.direction, 0.0f, r.t_max);
    if (shadow) {
      query.occluded(scene_, ray.ray);
    } else {
      query.intersect(scene_, ray);
    }
    benchmark::DoNotOptimize(ray);
  }
}

std::size_t BareEmbree::trace_packets(std::span<const renderer::Ray> rays, bool shadow, bool coherent) const {
  renderer::EmbreeQuery query(coherent);
  alignas(64) RTCRayHit16 packet{};
  alignas(64) int valid[16];
  std::size_t missed = 0;
  for (std::size_t first = 0; first < rays.size(); first += 16) {
    for (std::size_t i = 0; i < 16; ++i) {
      valid[i] = first + i < rays.size() ? -1 : 0;
      const renderer::Ray& r = rays[std::min(first + i, rays.size() - 1)];
      packet.ray.org_x[i] = r.origin.x();
      packet.ray.org_y[i] = r.origin.y();
      packet.ray.org_z[i] = r.origin.z();
      packet.ray.dir_x[i] = r.direction.x();
      packet.ray.dir_y[i] = r.direction.y();
      packet.ray.dir_z[i] = r.direction.z();
      packet.ray.tfar[i] = r.t_max;
      packet.ray.mask[i] = ~0u;
      packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    if (shadow) {
      query.occluded(valid, scene_, packet.ray);
    } else {
      query.intersect(valid, scene_, packet);
    }
    for (std::size_t i = 0; i < 16; ++i) {
      const bool hit = shadow ? packet.ray.tfar[i] < 0.0f : packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
      missed += valid[i] != 0 && !hit ? 1 : 0;
    }
  }
  return missed;
}

}  // namespace gatelight::bench
