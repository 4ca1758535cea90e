// Layouts: numbers of nodes, sizes of scenes and triangles, memory.

#include "base/errors.h"
#include "neural/layout/build_gate_layout.h"
#include "neural/layout/mesh_colors.h"
#include "tests/extremes/fast_backends.h"
#include "tests/support/messages.h"

namespace gatelight::neural {
namespace {

using namespace testing;

std::string refusal_of(const SurfaceLayout& surfaces, const GateOptions& options) {
  return tests::refusal<BadConfiguration>([&] { build_gate_layout(surfaces, options); });
}

GateOptions finest(NodeStorage storage) {
  GateOptions options;
  options.stack = {64};
  options.storage = storage;
  options.cluster = false;
  return options;
}

/// Greatest node of the last surface, in 32 bits as kernels number nodes.
std::uint32_t last_node(const GateLayout& layout, const OwnedMesh& mesh) {
  std::uint32_t greatest = 0;
  const auto surface = static_cast<std::uint32_t>(layout.surfaces.size() - 1);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t i = 0; i <= 64; ++i)
      for (std::uint32_t j = 0; i + j <= 64; ++j)
        greatest = std::max(greatest, node_index(layout, surface, 0, t, {i, j, 64 - i - j}));
  return greatest;
}

TEST(ExtremeLayouts, NodesUpTo2To32AreNumberedAndMoreAreRefused) {
  const OwnedMesh mesh = make_sheet(20, 0.1f, 1);
  for (const NodeStorage storage : {NodeStorage::shared, NodeStorage::per_triangle}) {
    SurfaceLayout surfaces;
    surfaces.meshes = {{mesh.positions, mesh.triangles}};
    surfaces.instances = {{.mesh = 0, .sides = Sides::both}};
    const std::uint64_t each = build_gate_layout(surfaces, finest(storage)).node_count;
    const std::uint64_t fit = 0xffffffffu / each;
    surfaces.instances.assign(fit, surfaces.instances[0]);
    const GateLayout layout = build_gate_layout(surfaces, finest(storage));
    EXPECT_EQ(layout.node_count, fit * each);
    EXPECT_EQ(last_node(layout, mesh), layout.node_count - 1);
    surfaces.instances.push_back(surfaces.instances[0]);
    tests::expect_message(refusal_of(surfaces, finest(storage)), {"2^32-1"});
    surfaces.instances.assign(100'000, surfaces.instances[0]);
    tests::expect_message(refusal_of(surfaces, finest(storage)), {"2^32-1"});
  }
}

TEST(ExtremeLayouts, BudgetsOfAnySizeAreKept) {
  const auto surfaces = make_small_surfaces();
  GateOptions options;
  for (const std::uint64_t budget : {std::uint64_t{1} << 12, ~std::uint64_t{0}}) {
    options.memory_budget = budget;
    const GateLayout layout = build_gate_layout(surfaces->layout(), options);
    EXPECT_LE(std::uint64_t{layout.node_count} * options.features * 4, budget);
    EXPECT_GT(layout.node_count, 0u);
  }
}

TEST(ExtremeLayouts, SpacingsAndScalesOfAnySizeGiveValidResolutions) {
  const auto surfaces = make_small_surfaces();
  for (const bool cluster : {false, true})
    for (const float spacing : {1e-38f, 1e-20f, 1e-6f, 1.0f, 1e6f, 1e20f, 3e38f})
      for (const float scale : {1e-38f, 1e-19f, 1e-6f, 1.0f, 1e6f, 1e19f, 1e38f}) {
        SurfaceLayout layout = surfaces->layout();
        for (SurfaceInstance& instance : layout.instances)
          for (float& x : instance.object_to_world) x *= scale;
        GateOptions options;
        options.node_spacing = spacing;
        options.cluster = cluster;
        const GateLayout made = build_gate_layout(layout, options);
        EXPECT_GT(made.node_count, 0u);
        for (const GateSurfaceLevel& level : made.levels) EXPECT_LE(level.resolution, options.max_resolution);
      }
}

// Areas of 1e308 m2 and their squares overflow double precision.
TEST(ExtremeLayouts, CoordinatesAtTheEndOfFloatsGiveValidResolutions) {
  constexpr float kLargest = std::numeric_limits<float>::max();
  OwnedMesh mesh = make_sheet(3, 0.0f, 1);
  for (Float3& p : mesh.positions)
    for (float& x : p) x = (x - 0.5f) * 2 * kLargest * 0.99f;
  for (const ResolutionRule rule : {ResolutionRule::uniform, ResolutionRule::paper, ResolutionRule::fixed})
    for (const float scale : {1e-38f, 1.0f, 1e10f, kLargest})
      for (const bool cluster : {false, true}) {
        if (cluster && rule != ResolutionRule::uniform) continue;
        SurfaceLayout surfaces;
        surfaces.meshes = {{mesh.positions, mesh.triangles}};
        surfaces.instances = {{.mesh = 0, .object_to_world = scaled_and_moved(scale, 0, 0, 0)}};
        GateOptions options;
        options.rule = rule;
        options.cluster = cluster;
        const GateLayout made = build_gate_layout(surfaces, options);
        EXPECT_GT(made.node_count, 0u);
        for (const GateSurfaceLevel& level : made.levels) {
          EXPECT_GE(level.resolution, 1u);
          EXPECT_LE(level.resolution, options.max_resolution);
        }
      }
}

TEST(ExtremeLayouts, DegenerateDuplicateAndFlippedTrianglesAgreeWithTheReference) {
  FastAgreement agreement;
  OwnedMesh mesh = make_sheet(2, 0.2f, 1);
  const auto triangles = mesh.triangles;
  mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());  // twice
  for (const auto& [a, b, c] : triangles) mesh.triangles.push_back({a, c, b});
  mesh.triangles.insert(mesh.triangles.end(), {{0, 0, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 0}, {2, 5, 2}});
  for (const std::uint32_t resolution : {1u, 2u, 32u}) {
    ModelConfig config = default_gate_config();
    config.gate.stack = {resolution};
    SurfaceLayout surfaces;
    surfaces.meshes = {{mesh.positions, mesh.triangles}};
    surfaces.instances = {{.mesh = 0, .sides = Sides::both}};
    const ModelCase c{"crooked", make_model(config, surfaces)};
    const TrainingOptions options = smooth_options();
    const ModelState state = random_state(*c.model, options, resolution, true);
    agreement.expect_same(fmt::format("R {}", resolution), c, options, state,
                          make_smooth_batch(*c.model, state, 500, resolution, {}));
  }
}

}  // namespace
}  // namespace gatelight::neural
