#include "renderer/surface/accel.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <vector>

#include "base/errors.h"
#include "base/simd/isa.h"
#include "renderer/surface/embree.h"
#include "renderer/surface/embree_api.h"
#include "renderer/surface/shadow_transmittance.h"

namespace gatelight::renderer {

namespace {

constexpr unsigned kPacket = 16;

/// Embree passes its context, the query's first member, to the filters: the rest is stored behind it.
struct Context {
  EmbreeQuery query;
  const Coverage* coverage;

  Context(const Coverage& surfaces, bool coherent) : query(coherent), coverage(&surfaces) {}
  bool lets_pass(const Hit& hit, bool back, std::uint32_t seed) const {
    if (back && coverage->culls_backs(hit.instance)) return true;
    return coverage->tests_alpha(hit.instance) && !coverage->is_there(hit, seed);
  }
};

struct RayContext : Context {
  std::uint32_t seeds[kPacket];  ///< of the lanes; not set where there are no filters

  using Context::Context;
};

struct ShadowContext : Context {
  ShadowTransmittance lanes[kPacket];

  using Context::Context;
};

std::uint32_t instance_of(unsigned instance, unsigned geometry) {
  return instance != RTC_INVALID_GEOMETRY_ID ? instance : geometry;
}

Hit candidate(const RTCFilterFunctionNArguments* args, unsigned i) {
  Hit hit;
  hit.t = RTCRayN_tfar(args->ray, args->N, i);
  hit.u = RTCHitN_u(args->hit, args->N, i);
  hit.v = RTCHitN_v(args->hit, args->N, i);
  hit.instance = instance_of(RTCHitN_instID(args->hit, args->N, i, 0), RTCHitN_geomID(args->hit, args->N, i));
  hit.primitive = RTCHitN_primID(args->hit, args->N, i);
  return hit;
}

/// Whether the ray meets the back of its triangle. Both are in the space of the mesh.
bool meets_back(const RTCFilterFunctionNArguments* args, unsigned i) {
  return RTCHitN_Ng_x(args->hit, args->N, i) * RTCRayN_dir_x(args->ray, args->N, i) +
             RTCHitN_Ng_y(args->hit, args->N, i) * RTCRayN_dir_y(args->ray, args->N, i) +
             RTCHitN_Ng_z(args->hit, args->N, i) * RTCRayN_dir_z(args->ray, args->N, i) >
         0.0f;
}

void ray_filter(const RTCFilterFunctionNArguments* args) {
  const RayContext& context = *reinterpret_cast<const RayContext*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    const std::uint32_t seed = context.seeds[RTCRayN_id(args->ray, args->N, i)];
    if (context.lets_pass(candidate(args, i), meets_back(args, i), seed)) args->valid[i] = 0;
  }
}

void shadow_filter(const RTCFilterFunctionNArguments* args) {
  ShadowContext& context = *reinterpret_cast<ShadowContext*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    ShadowTransmittance& lane = context.lanes[RTCRayN_id(args->ray, args->N, i)];
    const Hit hit = candidate(args, i);
    if (context.lets_pass(hit, meets_back(args, i), lane.seed) || lane.pass(*context.coverage, hit))
      args->valid[i] = 0;
  }
}

/// Calls trace(first, count, valid) for packets of the rays. Before it, set(lane, ray) fills each lane; lanes
/// without a ray of their own repeat the last ray.
template <typename Set, typename Trace>
void for_each_packet(std::span<const Ray> rays, const Set& set, const Trace& trace) {
  alignas(64) int valid[kPacket];
  for (std::size_t first = 0; first < rays.size(); first += kPacket) {
    const unsigned count = static_cast<unsigned>(std::min<std::size_t>(kPacket, rays.size() - first));
    for (unsigned i = 0; i < kPacket; ++i) {
      valid[i] = i < count ? -1 : 0;
      set(i, rays[first + std::min(i, count - 1)]);
    }
    trace(first, count, valid);
  }
}

void set_ray(RTCRay16& packet, unsigned i, const Ray& ray) {
  packet.org_x[i] = ray.origin.x();
  packet.org_y[i] = ray.origin.y();
  packet.org_z[i] = ray.origin.z();
  packet.dir_x[i] = ray.direction.x();
  packet.dir_y[i] = ray.direction.y();
  packet.dir_z[i] = ray.direction.z();
  packet.tnear[i] = 0.0f;
  packet.tfar[i] = ray.t_max;
  packet.time[i] = ray.time;
  packet.mask[i] = ray.mask;
  packet.id[i] = i;
  packet.flags[i] = 0;
}

const char* embree_isa(const std::string& isa) {
  if (isa == "scalar") return "sse2";
  if (isa == "avx2") return "avx2";
  if (isa == "avx512") return "avx512";
  return nullptr;
}

bool has_isa(const std::string& name) {
  const std::optional<simd::Isa> isa = simd::parse_isa(name);
  const std::vector<simd::Isa> there = simd::available_isas();
  return !isa || std::find(there.begin(), there.end(), *isa) != there.end();
}

}  // namespace

std::string best_isa() {
  return std::string(simd::isa_name(simd::available_isas().back()));
}

std::string embree_version() {
  return RTC_VERSION_STRING;
}

struct Accel::State {
  std::atomic<long long> bytes{0};
  std::size_t limit = 0;
  std::atomic<bool> refused{false};
  std::string first_error;
  bool watertight = true;
  bool spatial_splits = true;
  RTCDevice device = nullptr;
  RTCScene still = nullptr;
  RTCScene moving = nullptr;  ///< null: nothing moves
  std::vector<RTCScene> meshes;
  bool any_filter = false;
  const RayMasks* masks = nullptr;            ///< during a build
  std::vector<std::uint32_t> masks_of_still;  ///< by instance

  State() = default;
  State(const State&) = delete;
  ~State() {
    for (RTCScene below : meshes) release(below);
    release(still);
    release(moving);
    if (device) rtcReleaseDevice(device);
  }

  static void release(RTCScene& scene) {
    if (scene) rtcReleaseScene(scene);
    scene = nullptr;
  }

  RTCScene new_scene() const {
    RTCScene s = rtcNewScene(device);
    const bool high = watertight || spatial_splits;
    rtcSetSceneBuildQuality(s, high ? RTC_BUILD_QUALITY_HIGH : RTC_BUILD_QUALITY_MEDIUM);
    // Without this flag rays slip through the shared edges of triangles, and a closed room leaks light.
    rtcSetSceneFlags(s, watertight ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    return s;
  }

  static void set_positions(RTCGeometry geometry, unsigned step, const PaddedVector<Vec3>& positions) {
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, step, RTC_FORMAT_FLOAT3, positions.data(), 0,
                               sizeof(Vec3), positions.size());
  }

  /// A mesh with the filters that the coverage of the instance needs. `states`: of an open shutter, or empty.
  RTCGeometry new_mesh(const scene::Scene& scene, const Coverage& coverage, std::uint32_t instance,
                       const std::vector<scene::DeformedVertices>& states = {}) {
    const scene::Mesh& mesh = scene.mesh_of(scene.instances[instance]);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (states.empty()) {
      set_positions(geometry, 0, mesh.positions);
    } else {
      rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(states.size()));
      for (unsigned step = 0; step < states.size(); ++step)
        set_positions(geometry, step, states[step].positions);
    }
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(mesh.triangles[0]), mesh.triangles.size());
    if (coverage.tests_alpha(instance) || coverage.culls_backs(instance)) {
      rtcSetGeometryIntersectFilterFunction(geometry, ray_filter);
    }
    if (coverage.filters_shadows(instance)) {
      rtcSetGeometryOccludedFilterFunction(geometry, shadow_filter);
      any_filter = true;
    }
    rtcSetGeometryMask(geometry, scene.instances[instance].baked ? masks->of_instance(instance) : ~0u);
    rtcCommitGeometry(geometry);
    return geometry;
  }

  std::vector<std::uint32_t> all_masks(const scene::Scene& scene) const {
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) all.push_back(masks->of_instance(i));
    return all;
  }
  /// Whether other rays than before see some object that does not move.
  bool sees_still_anew(const scene::Scene& scene) const {
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      if (!scene.instances[i].moves && masks->of_instance(i) != masks_of_still[i]) return true;
    }
    return false;
  }

  static void set_transform(RTCGeometry geometry, unsigned step, const Affine& transform) {
    rtcSetGeometryTransform(geometry, step, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, transform.data());
  }

  /// The mesh of the instance, placed. It is built once for all instances.
  RTCGeometry new_instance(const scene::Scene& scene, const Coverage& coverage, std::uint32_t i) {
    const scene::Instance& instance = scene.instances[i];
    const scene::ShutterMotion& shutter = scene.shutter;
    const auto mesh = static_cast<std::size_t>(instance.mesh);
    RTCScene& below = meshes[mesh];
    if (!below) {
      below = new_scene();
      RTCGeometry child = shutter.instances ? new_mesh(scene, coverage, i, shutter.vertices[mesh])
                                            : new_mesh(scene, coverage, i);
      rtcAttachGeometry(below, child);
      rtcReleaseGeometry(child);
      rtcCommitScene(below);
    }
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(geometry, below);
    if (shutter.instances && !shutter.transforms[i].empty()) {
      const std::vector<Affine>& states = shutter.transforms[i];
      rtcSetGeometryTimeStepCount(geometry, static_cast<unsigned>(states.size()));
      for (unsigned step = 0; step < states.size(); ++step) set_transform(geometry, step, states[step]);
    } else {
      set_transform(geometry, 0, instance.transform);
    }
    rtcSetGeometryMask(geometry, masks->of_instance(i));
    rtcCommitGeometry(geometry);
    return geometry;
  }

  static void attach(RTCScene top, RTCGeometry geometry, std::uint32_t i) {
    rtcAttachGeometryByID(top, geometry, i);
    rtcReleaseGeometry(geometry);
  }

  /// Baked meshes lie in the top level; the others are built once each, and placed.
  void build_still(const scene::Scene& scene, const Coverage& coverage) {
    release(still);
    still = new_scene();
    meshes.resize(scene.meshes.size(), nullptr);
    masks_of_still = all_masks(scene);
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      const scene::Instance& instance = scene.instances[i];
      if (scene.mesh_of(instance).triangles.empty() || instance.moves) continue;
      attach(still, instance.baked ? new_mesh(scene, coverage, i) : new_instance(scene, coverage, i), i);
    }
    rtcCommitScene(still);
  }

  void build_moving(const scene::Scene& scene, const Coverage& coverage) {
    release(moving);
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
      if (scene.meshes[m].deforming >= 0) release(meshes[m]);
    }
    if (!scene.motion.instances) return;
    moving = new_scene();
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
      const scene::Instance& instance = scene.instances[i];
      if (!instance.moves || instance.hidden || scene.mesh_of(instance).triangles.empty()) continue;
      attach(moving, new_instance(scene, coverage, i), i);
    }
    rtcCommitScene(moving);
  }

  static bool monitor(void* self, ssize_t bytes, bool) {
    State& state = *static_cast<State*>(self);
    const long long total = state.bytes.fetch_add(bytes) + bytes;
    // Embree also calls this for memory that it frees. Only growth can be refused.
    if (state.limit > 0 && bytes > 0 && total > static_cast<long long>(state.limit)) {
      state.refused = true;
      return false;
    }
    return true;
  }
  static void error(void* self, RTCError code, const char* text) {
    State& state = *static_cast<State*>(self);
    if (code == RTC_ERROR_OUT_OF_MEMORY) state.refused = true;
    if (state.first_error.empty()) state.first_error = text;
  }
};

Accel::Accel(const scene::Scene& scene, const Coverage& coverage, const RayMasks& masks,
             const AccelOptions& options)
    : coverage_(&coverage), state_(std::make_unique<State>()) {
  State& state = *state_;
  if (!has_isa(options.isa)) {
    throw Unavailable(
        {"isa", options.isa, "is more than this processor has", fmt::format("at most {}", best_isa())});
  }
  isa_ = options.isa == "auto" ? best_isa() : options.isa;
  std::string config = fmt::format("threads={}", options.threads);
  if (const char* isa = embree_isa(options.isa)) config += fmt::format(",isa={}", isa);
  state.device = rtcNewDevice(config.c_str());
  if (!state.device) {
    const RTCError error = rtcGetDeviceError(nullptr);
    const std::string text = fmt::format("Embree refuses the device \"{}\"", config);
    if (error == RTC_ERROR_UNSUPPORTED_CPU || error == RTC_ERROR_INVALID_ARGUMENT) throw Unavailable(text);
    throw OutOfMemory(text + ": memory or threads are not available");
  }
  state.limit = options.memory_limit_bytes;
  rtcSetDeviceErrorFunction(state.device, State::error, &state);
  rtcSetDeviceMemoryMonitorFunction(state.device, State::monitor, &state);

  require_masks(scene, masks);
  state.masks = &masks;
  state.watertight = options.watertight;
  state.spatial_splits = options.spatial_splits;
  state.build_still(scene, coverage);
  state.build_moving(scene, coverage);
  check(scene);
}

void Accel::update(const scene::Scene& scene, const Coverage& coverage, const RayMasks& masks) {
  coverage_ = &coverage;
  state_->masks = &masks;
  const bool anew = state_->sees_still_anew(scene);
  if (anew) {
    require_masks(scene, masks);
    state_->build_still(scene, coverage);
  }
  if (!scene.motion.instances && !anew) return;
  state_->build_moving(scene, coverage);
  check(scene);
}

void Accel::require_masks(const scene::Scene& scene, const RayMasks& masks) const {
  if (masks.all_alike() || rtcGetDeviceProperty(state_->device, RTC_DEVICE_PROPERTY_RAY_MASK_SUPPORTED) != 0)
    return;
  throw Unavailable(fmt::format(
      "{}: this Embree is built without ray masks, which objects need that only some rays see", scene.path));
}

void Accel::check(const scene::Scene& scene) const {
  const State& state = *state_;
  const RTCError error = rtcGetDeviceError(state.device);
  if (error != RTC_ERROR_NONE || state.refused || !state.first_error.empty()) {
    if (state.refused || error == RTC_ERROR_OUT_OF_MEMORY) {
      const std::string limit =
          state.refused ? fmt::format("`memory-limit` {}", state.limit >> 20) : "there is";
      throw OutOfMemory(fmt::format("{}: the acceleration structure needs over {} MiB, more than {}",
                                    scene.path, state.bytes.load() >> 20, limit));
    }
    throw InputError(fmt::format("{}: Embree cannot build the scene: {}", scene.path, state.first_error));
  }
}

Accel::~Accel() = default;

std::size_t Accel::bytes() const {
  return static_cast<std::size_t>(std::max(0ll, state_->bytes.load()));
}

Hit Accel::intersect(const Ray& ray) const {
  RayContext context(*coverage_, false);
  context.seeds[0] = ray.seed;
  const Vec3 &o = ray.origin, &d = ray.direction;
  RTCRayHit one{{o.x(), o.y(), o.z(), 0.0f, d.x(), d.y(), d.z(), ray.time, ray.t_max, ray.mask, 0, 0}, {}};
  one.hit.geomID = one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  context.query.intersect(state_->still, one);
  if (state_->moving) context.query.intersect(state_->moving, one);
  return {one.ray.tfar,   one.hit.u,   one.hit.v, instance_of(one.hit.instID[0], one.hit.geomID),
          one.hit.primID, one.ray.time};
}

void Accel::intersect(std::span<const Ray> rays, std::span<Hit> hits, bool coherent) const {
  RayContext context(*coverage_, coherent);
  alignas(64) RTCRayHit16 packet;
  const auto set = [&](unsigned i, const Ray& ray) {
    set_ray(packet.ray, i, ray);
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    context.seeds[i] = ray.seed;
  };
  for_each_packet(rays, set, [&](std::size_t first, unsigned count, const int* valid) {
    context.query.intersect(valid, state_->still, packet);
    if (state_->moving) context.query.intersect(valid, state_->moving, packet);
    for (unsigned i = 0; i < count; ++i) {
      Hit& hit = hits[first + i];
      hit.t = packet.ray.tfar[i];
      hit.u = packet.hit.u[i];
      hit.v = packet.hit.v[i];
      hit.primitive = packet.hit.primID[i];
      hit.time = packet.ray.time[i];
      hit.instance = instance_of(packet.hit.instID[0][i], packet.hit.geomID[i]);
    }
  });
}

void Accel::transmittance(std::span<const Ray> rays, std::span<Color> result) const {
  ShadowContext context(*coverage_, false);
  alignas(64) RTCRay16 packet;
  const auto weakens = [&](const Ray& ray) { return state_->any_filter || ray.inside; };
  const auto set = [&](unsigned i, const Ray& ray) {
    set_ray(packet, i, ray);
    if (weakens(ray)) context.lanes[i].start(ray);
  };
  for_each_packet(rays, set, [&](std::size_t first, unsigned count, const int* valid) {
    context.query.occluded(valid, state_->still, packet);
    if (state_->moving) context.query.occluded(valid, state_->moving, packet);
    for (unsigned i = 0; i < count; ++i) {
      const bool blocked = packet.tfar[i] < 0.0f;
      const Ray& ray = rays[first + i];
      result[first + i] = blocked        ? Color(0.0f, 0.0f, 0.0f)
                          : weakens(ray) ? context.lanes[i].passed(*coverage_, ray.t_max)
                                         : Color(1.0f, 1.0f, 1.0f);
    }
  });
}

}  // namespace gatelight::renderer
