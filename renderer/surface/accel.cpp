#include "renderer/surface/accel.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <optional>
#include <tuple>
#include <vector>

#include "neural/simd/isa.h"
#include "renderer/machine/errors.h"
#include "renderer/surface/embree.h"

namespace gatelight::renderer {

namespace {

constexpr unsigned kPacket = 16;

/// Where a ray enters or leaves glass with an inside. Not initialised: a lane has many.
struct Boundary {
  float t, u, v;
  std::uint32_t instance, primitive, volume;
  bool front;

  Hit hit() const { return {t, u, v, instance, primitive}; }
};

struct Lane {
  std::uint32_t seed = 0;
  Vec3 direction = Vec3::Zero();  ///< in world space; Embree's is in the space of the instance
  Color transmittance{1.0f, 1.0f, 1.0f};
  /// Of the media along the ray: their optical depth up to the ends that were met, less that before their
  /// beginnings, and the absorption per metre of those that have not ended.
  Color depth{0.0f, 0.0f, 0.0f};
  Color inside{0.0f, 0.0f, 0.0f};
  bool absorbed = false;  ///< whether one of them absorbs
  int panes = 0;
  int boundaries = 0;                    ///< of volumes of Media, among the panes
  std::uint64_t seen[Accel::kMaxPanes];  ///< the first `panes`: spatial splits repeat a triangle
  Boundary boundary[Accel::kMaxPanes];   ///< the first `boundaries`, in any order

  void pass(const Passage& passage, float t) {
    transmittance *= passage.transmittance;
    if ((passage.absorption == 0.0f).all()) return;
    absorbed = true;
    depth -= passage.absorption * t;
    inside += passage.absorption;
  }
  /// The light that is left. A medium without an end in this distance absorbs all along it, but none of the
  /// light of a sky: walkers do the same.
  Color passed(const Coverage& coverage, float distance) {
    const Color nested = boundaries > 0 ? through_boundaries(coverage, distance) : Color(Color::Ones());
    if (!absorbed) return transmittance * nested;
    Color all = depth;
    if (distance < scene::kInfinity) all += inside.max(0.0f) * distance;
    return transmittance * nested * (-all.max(0.0f)).exp();
  }

 private:
  /// What is met of a volume depends on where the ray is, so its boundaries are passed in their order.
  [[gnu::noinline, gnu::cold]] Color through_boundaries(const Coverage& coverage, float distance) {
    const std::span<Boundary> all(boundary, static_cast<std::size_t>(boundaries));
    std::sort(all.begin(), all.end(), [](const Boundary& a, const Boundary& b) {
      return std::tuple(a.t, a.instance, a.primitive) < std::tuple(b.t, b.instance, b.primitive);
    });
    // What the ray leaves first it was in from the start.
    Interior in;
    for (auto b = all.begin(); b != all.end(); ++b) {
      const bool first =
          std::none_of(all.begin(), b, [&](const Boundary& a) { return a.volume == b->volume; });
      if (first && !b->front && b->volume != scene::kNoVolume) in.enter(b->volume);
    }
    // As Walker::cross().
    const Media& media = coverage.media();
    Color light = Color::Ones(), absorption = Color::Zero(), here = media.of(in.strongest()).absorption;
    float at = 0.0f;
    for (const Boundary& b : all) {
      const Passage passage = coverage.pass(b.hit(), direction, in);
      const bool listed = b.volume != scene::kNoVolume;
      if (at == 0.0f && !listed && !b.front) here = -passage.absorption;
      absorption += here * (b.t - at);
      at = b.t;
      light *= passage.transmittance;
      if (listed) in.cross(b.volume, b.front);
      here = listed || !b.front ? media.of(in.strongest()).absorption : passage.absorption;
    }
    if (distance < scene::kInfinity) absorption += here * (distance - at);
    return light * (-absorption).exp();
  }
};

/// Embree passes its context to the filters, so the lanes are stored behind it.
struct Context {
  RTCIntersectContext embree;
  const Coverage* coverage;
  Lane lanes[kPacket];

  Context(const Coverage& surfaces, RTCIntersectContextFlags flags) : coverage(&surfaces) {
    rtcInitIntersectContext(&embree);
    embree.flags = flags;
  }
  bool lets_pass(const Hit& hit, bool back, const Lane& lane) const {
    if (back && coverage->culls_backs(hit.instance)) return true;
    return coverage->tests_alpha(hit.instance) && !coverage->is_there(hit, lane.seed);
  }
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
  const Context& context = *reinterpret_cast<const Context*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    const Lane& lane = context.lanes[RTCRayN_id(args->ray, args->N, i)];
    if (context.lets_pass(candidate(args, i), meets_back(args, i), lane)) args->valid[i] = 0;
  }
}

void shadow_filter(const RTCFilterFunctionNArguments* args) {
  Context& context = *reinterpret_cast<Context*>(args->context);
  for (unsigned i = 0; i < args->N; ++i) {
    if (args->valid[i] != -1) continue;
    Lane& lane = context.lanes[RTCRayN_id(args->ray, args->N, i)];
    const Hit hit = candidate(args, i);
    if (context.lets_pass(hit, meets_back(args, i), lane)) {
      args->valid[i] = 0;
      continue;
    }
    const Passage passage = context.coverage->pass(hit, lane.direction);
    if ((passage.transmittance <= 0.0f).all()) continue;
    const std::uint64_t id = static_cast<std::uint64_t>(hit.instance) << 32 | hit.primitive;
    if (std::find(lane.seen, lane.seen + lane.panes, id) == lane.seen + lane.panes) {
      if (lane.panes == Accel::kMaxPanes) continue;
      lane.seen[lane.panes++] = id;
      if (!context.coverage->orders(hit.instance)) {
        lane.pass(passage, hit.t);
      } else {
        const std::uint32_t volume = context.coverage->media().volume_of(hit.instance);
        lane.boundary[lane.boundaries++] = {hit.t,         hit.u,  hit.v,        hit.instance,
                                            hit.primitive, volume, passage.front};
      }
    }
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
  packet.time[i] = 0.0f;
  packet.mask[i] = ~0u;
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
  const std::optional<neural::simd::Isa> isa = neural::simd::parse_isa(name);
  const std::vector<neural::simd::Isa> there = neural::simd::available_isas();
  return !isa || std::find(there.begin(), there.end(), *isa) != there.end();
}

}  // namespace

std::string best_isa() {
  return std::string(neural::simd::isa_name(neural::simd::available_isas().back()));
}

std::string embree_version() {
  return RTC_VERSION_STRING;
}

struct Accel::State {
  std::atomic<long long> bytes{0};
  std::size_t limit = 0;
  std::atomic<bool> refused{false};
  std::string first_error;
  RTCDevice device = nullptr;
  RTCScene top = nullptr;
  std::vector<RTCScene> meshes;
  bool any_filter = false;

  State() = default;
  State(const State&) = delete;
  ~State() {
    for (RTCScene below : meshes) {
      if (below) rtcReleaseScene(below);
    }
    if (top) rtcReleaseScene(top);
    if (device) rtcReleaseDevice(device);
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

Accel::Accel(const scene::Scene& scene, const Coverage& coverage, const AccelOptions& options)
    : coverage_(coverage), state_(std::make_unique<State>()) {
  State& state = *state_;
  if (!has_isa(options.isa)) {
    throw Unavailable(
        fmt::format("--isa {}: this processor does not have it; its best is {}", options.isa, best_isa()));
  }
  isa_ = options.isa == "auto" ? best_isa() : options.isa;
  std::string config = fmt::format("threads={}", options.threads);
  if (const char* isa = embree_isa(options.isa)) config += fmt::format(",isa={}", isa);
  state.device = rtcNewDevice(config.c_str());
  if (!state.device) {
    const RTCError error = rtcGetDeviceError(nullptr);
    const std::string text = fmt::format("Embree refuses the device \"{}\"", config);
    if (error == RTC_ERROR_UNSUPPORTED_CPU || error == RTC_ERROR_INVALID_ARGUMENT) throw Unavailable(text);
    throw OutOfMemory(text + ": there is no memory for it, or no thread");
  }
  state.limit = options.memory_limit_bytes;
  rtcSetDeviceErrorFunction(state.device, State::error, &state);
  rtcSetDeviceMemoryMonitorFunction(state.device, State::monitor, &state);

  const auto new_scene = [&] {
    RTCScene s = rtcNewScene(state.device);
    rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_HIGH);
    // Without this flag rays slip through the shared edges of triangles, and a closed room leaks light.
    rtcSetSceneFlags(s, options.watertight ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    return s;
  };
  const auto new_mesh = [&](const scene::Mesh& mesh, std::uint32_t instance) {
    RTCGeometry geometry = rtcNewGeometry(state.device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(),
                               0, sizeof(Vec3), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                               sizeof(mesh.triangles[0]), mesh.triangles.size());
    if (coverage.tests_alpha(instance) || coverage.culls_backs(instance)) {
      rtcSetGeometryIntersectFilterFunction(geometry, ray_filter);
    }
    if (coverage.filters_shadows(instance)) {
      rtcSetGeometryOccludedFilterFunction(geometry, shadow_filter);
      state.any_filter = true;
    }
    rtcCommitGeometry(geometry);
    return geometry;
  };

  state.top = new_scene();
  state.meshes.assign(scene.meshes.size(), nullptr);
  for (std::uint32_t i = 0; i < scene.instances.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    const scene::Mesh& mesh = scene.mesh_of(instance);
    if (mesh.triangles.empty()) continue;
    RTCGeometry geometry = nullptr;
    if (instance.baked) {
      geometry = new_mesh(mesh, i);
    } else {
      RTCScene& below = state.meshes[static_cast<std::size_t>(instance.mesh)];
      if (!below) {
        below = new_scene();
        RTCGeometry child = new_mesh(mesh, i);
        rtcAttachGeometry(below, child);
        rtcReleaseGeometry(child);
        rtcCommitScene(below);
      }
      geometry = rtcNewGeometry(state.device, RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, below);
      rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, instance.transform.data());
      rtcCommitGeometry(geometry);
    }
    rtcAttachGeometryByID(state.top, geometry, i);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(state.top);
  const RTCError error = rtcGetDeviceError(state.device);
  if (error != RTC_ERROR_NONE || state.refused || !state.first_error.empty()) {
    if (state.refused || error == RTC_ERROR_OUT_OF_MEMORY) {
      const std::string limit =
          state.refused ? fmt::format("--memory-limit {}", options.memory_limit_bytes >> 20) : "there is";
      throw OutOfMemory(fmt::format("{}: the acceleration structure needs over {} MiB, more than {}",
                                    scene.path, state.bytes.load() >> 20, limit));
    }
    throw std::runtime_error(
        fmt::format("{}: Embree cannot build the scene: {}", scene.path, state.first_error));
  }
}

Accel::~Accel() = default;

std::size_t Accel::bytes() const {
  return static_cast<std::size_t>(std::max(0ll, state_->bytes.load()));
}

void Accel::intersect(std::span<const Ray> rays, std::span<Hit> hits, bool coherent) const {
  Context context(coverage_,
                  coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  alignas(64) RTCRayHit16 packet;
  const auto set = [&](unsigned i, const Ray& ray) {
    set_ray(packet.ray, i, ray);
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    if (state_->any_filter) context.lanes[i].seed = ray.seed;
  };
  for_each_packet(rays, set, [&](std::size_t first, unsigned count, const int* valid) {
    rtcIntersect16(valid, state_->top, &context.embree, &packet);
    for (unsigned i = 0; i < count; ++i) {
      Hit& hit = hits[first + i];
      hit.t = packet.ray.tfar[i];
      hit.u = packet.hit.u[i];
      hit.v = packet.hit.v[i];
      hit.primitive = packet.hit.primID[i];
      hit.instance = instance_of(packet.hit.instID[0][i], packet.hit.geomID[i]);
    }
  });
}

void Accel::transmittance(std::span<const Ray> rays, std::span<Color> result) const {
  Context context(coverage_, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
  alignas(64) RTCRay16 packet;
  const auto set = [&](unsigned i, const Ray& ray) {
    set_ray(packet, i, ray);
    if (!state_->any_filter) return;
    Lane& lane = context.lanes[i];
    lane.seed = ray.seed;
    lane.direction = ray.direction;
    lane.transmittance = Color::Ones();
    if (lane.absorbed) {
      lane.depth.setZero();
      lane.inside.setZero();
      lane.absorbed = false;
    }
    lane.panes = lane.boundaries = 0;
  };
  for_each_packet(rays, set, [&](std::size_t first, unsigned count, const int* valid) {
    rtcOccluded16(valid, state_->top, &context.embree, &packet);
    for (unsigned i = 0; i < count; ++i) {
      const bool blocked = packet.tfar[i] < 0.0f;
      result[first + i] = blocked              ? Color(0.0f, 0.0f, 0.0f)
                          : state_->any_filter ? context.lanes[i].passed(coverage_, rays[first + i].t_max)
                                               : Color(1.0f, 1.0f, 1.0f);
    }
  });
}

}  // namespace gatelight::renderer
