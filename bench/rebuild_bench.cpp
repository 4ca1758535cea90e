// rebuild/{high,medium,low,refit}: the BVH of a cloth of 131 072 triangles whose vertices have moved, built
// anew with a quality of Embree, or refitted to them. `Mrays/s` is the speed of rays in it afterwards, in
// packets of 16.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/clock.h"
#include "bench/bare_embree.h"
#include "renderer/sampling/sampler.h"
#include "renderer/sampling/warp.h"

namespace gatelight::bench {
namespace {

constexpr int kRows = 256;
constexpr std::size_t kRays = 1 << 18;

/// A crumpled cloth; its waves run with the time.
Vec3 cloth(float u, float v, float time) {
  const auto wave = [&](float frequency, float amplitude, float phase) {
    return amplitude * std::sin(frequency * u + 0.7f * frequency * v + phase + 3.0f * time);
  };
  return {2.0f * u - 1.0f + wave(23.0f, 0.05f, 0.3f), wave(7.0f, 0.3f, 0.0f) + wave(41.0f, 0.1f, 1.0f),
          2.0f * v - 1.0f + wave(29.0f, 0.05f, 2.0f)};
}

/// Rays from random points, in random directions.
std::vector<RTCRayHit16> make_packets() {
  std::vector<RTCRayHit16> packets(kRays / 16);
  std::uint32_t index = 0;
  for (RTCRayHit16& packet : packets) {
    for (std::uint32_t i = 0; i < 16; ++i) {
      const renderer::Sampler sampler(renderer::SamplerKind::independent, 1, index++, 0, 0);
      const Vec3 origin = 0.8f * renderer::sample_uniform_sphere(sampler.get_2d(0)) * sampler.get_1d(2);
      const Vec3 direction = renderer::sample_uniform_sphere(sampler.get_2d(3));
      packet.ray.org_x[i] = origin.x();
      packet.ray.org_y[i] = origin.y();
      packet.ray.org_z[i] = origin.z();
      packet.ray.dir_x[i] = direction.x();
      packet.ray.dir_y[i] = direction.y();
      packet.ray.dir_z[i] = direction.z();
      packet.ray.tfar[i] = kInfinity;
      packet.ray.mask[i] = ~0u;
      packet.hit.geomID[i] = packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
  }
  return packets;
}

class Cloth {
 public:
  explicit Cloth(RTCBuildQuality quality) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    // Embree refits, and builds by Morton codes, only in scenes of low quality.
    const bool low = quality == RTC_BUILD_QUALITY_REFIT || quality == RTC_BUILD_QUALITY_LOW;
    rtcSetSceneBuildQuality(scene_, low ? RTC_BUILD_QUALITY_LOW : quality);
    rtcSetSceneFlags(scene_, low ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_ROBUST);
    for (int y = 0; y < kRows; ++y) {
      for (int x = 0; x < kRows; ++x) {
        const auto at = static_cast<std::uint32_t>(y * (kRows + 1) + x);
        const std::uint32_t below = at + kRows + 1;
        indices_.insert(indices_.end(), {at, at + 1, below + 1, at, below + 1, below});
      }
    }
    geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    constexpr std::size_t kVertices = (kRows + 1) * (kRows + 1);
    vertices_ = static_cast<Vec3*>(rtcSetNewGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0,
                                                           RTC_FORMAT_FLOAT3, sizeof(Vec3), kVertices));
    rtcSetSharedGeometryBuffer(geometry_, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, indices_.data(), 0,
                               3 * sizeof(std::uint32_t), indices_.size() / 3);
    if (low) rtcSetGeometryBuildQuality(geometry_, quality);
    rtcAttachGeometry(scene_, geometry_);
    move(0.0f);
    build();
  }
  ~Cloth() {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  Cloth(const Cloth&) = delete;
  Cloth& operator=(const Cloth&) = delete;

  void move(float time) {
    for (int y = 0; y <= kRows; ++y) {
      for (int x = 0; x <= kRows; ++x) {
        vertices_[y * (kRows + 1) + x] =
            cloth(static_cast<float>(x) / kRows, static_cast<float>(y) / kRows, time);
      }
    }
    rtcUpdateGeometryBuffer(geometry_, RTC_BUFFER_TYPE_VERTEX, 0);
  }

  void build() {
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }

  /// Millions of rays in a second, of one thread.
  double trace() const {
    static const std::vector<RTCRayHit16> packets = make_packets();
    renderer::EmbreeQuery query(false);
    alignas(64) int valid[16];
    std::fill(std::begin(valid), std::end(valid), -1);
    const Clock::time_point start = Clock::now();
    for (const RTCRayHit16& rays : packets) {
      RTCRayHit16 packet = rays;
      query.intersect(valid, scene_, packet);
      benchmark::DoNotOptimize(packet);
    }
    return 16e-6 * static_cast<double>(packets.size()) / seconds_since(start);
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
  RTCGeometry geometry_ = nullptr;
  Vec3* vertices_ = nullptr;
  std::vector<std::uint32_t> indices_;
};

void rebuild(benchmark::State& state, RTCBuildQuality quality) {
  Cloth cloth(quality);
  float time = 0.0f;
  for (auto _ : state) {
    cloth.move(time += 1.0f / 24.0f);
    const Clock::time_point start = Clock::now();
    cloth.build();
    state.SetIterationTime(seconds_since(start));
  }
  state.counters["Mrays/s"] = cloth.trace();
}

BENCHMARK_CAPTURE(rebuild, high, RTC_BUILD_QUALITY_HIGH)
    ->Name("rebuild/high")
    ->UseManualTime()
    ->Iterations(24);
BENCHMARK_CAPTURE(rebuild, medium, RTC_BUILD_QUALITY_MEDIUM)
    ->Name("rebuild/medium")
    ->UseManualTime()
    ->Iterations(24);
BENCHMARK_CAPTURE(rebuild, low, RTC_BUILD_QUALITY_LOW)->Name("rebuild/low")->UseManualTime()->Iterations(24);
BENCHMARK_CAPTURE(rebuild, refit, RTC_BUILD_QUALITY_REFIT)
    ->Name("rebuild/refit")
    ->UseManualTime()
    ->Iterations(24);

}  // namespace
}  // namespace gatelight::bench
