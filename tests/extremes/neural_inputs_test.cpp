// Inputs: points at borders and beyond, directions that are not unit vectors. Layouts: numbers of nodes,
// sizes of scenes and triangles, memory.

#include "base/errors.h"
#include "neural/layout/build_gate_layout.h"
#include "neural/layout/mesh_colors.h"
#include "tests/extremes/fast_backends.h"
#include "tests/support/messages.h"

namespace gatelight::neural {
namespace {

using namespace testing;

constexpr float kGreatest = std::numeric_limits<float>::max();

ModelCase plain(InputSource source, InputEncoding encoding, std::uint32_t size) {
  ModelConfig config = default_plain_config();
  config.auxiliary = {{source, encoding, size}};
  return make_case("plain", config);
}

void expect_same_answers(const ModelCase& c, const OwnedBatch& batch) {
  EXPECT_LE(worst_answers(c, {}, random_state(*c.model, {}, 1, false), batch), tolerance_of(*c.model));
}

/// Expects finite answers, also while such points are training records.
void expect_finite_beyond(const ModelCase& c, const OwnedBatch& batch) {
  for (const auto& fast : fast_backends(c.model, {})) {
    EXPECT_TRUE(all_finite(raw_answers(*fast, *c.model, batch))) << fast->name();
    for (int step = 0; step < 5; ++step) fast->train(batch.training());
    expect_finite(*fast, batch, *c.model);
  }
}

TEST(ExtremeInputs, OneBlobAtItsBordersAgreesWithTheReference) {
  const float inside = std::nextafter(1.0f, 0.0f), below = std::nextafter(0.25f, 0.0f);
  const std::vector<float> values = {0.0f,  -0.0f, 1e-45f,  1e-38f, 1e-7f, 0.5f, inside, 1.0f,      0.25f,
                                     0.75f, below, -0.125f, 1.125f, -1.0f, 2.0f, 1e30f,  -kGreatest};
  for (const std::uint32_t bins : {2u, 4u, 64u})
    for (const InputSource source : {InputSource::roughness, InputSource::albedo, InputSource::position}) {
      const ModelCase c = plain(source, InputEncoding::one_blob, bins);
      OwnedBatch batch = make_batch(*c.model, values.size(), 1);
      for (std::size_t r = 0; r < values.size(); ++r) {
        if (source == InputSource::roughness) batch.roughnesses[r] = values[r];
        if (source == InputSource::albedo)
          batch.albedos[r] = {values[r], inside, values[values.size() - 1 - r]};
        // In the bounds' coordinates: the ends of their longest side among them.
        if (source == InputSource::position)
          batch.positions[r] = {4 * std::clamp(values[r], -1e30f, 1e30f) - 1, -2, 1.5f};
      }
      expect_same_answers(c, batch);
      expect_finite_beyond(c, batch);
    }
}

TEST(ExtremeInputs, DirectionsAtPolesAndSeamsAgreeWithTheReference) {
  const float tiny = 1e-7f;
  const std::vector<Float3> directions = {
      {0, 0, 1},  {0, 0, -1},    {-0.0f, -0.0f, 1}, {1, 0, 0},    {-1, 0, 0},     {-1, -0.0f, 0},  {0, 1, 0},
      {0, -1, 0}, {-1, tiny, 0}, {-1, -tiny, 0},    {tiny, 0, 1}, {-tiny, 0, -1}, {0.6f, 0.8f, 0}, {0, 0, 0}};
  for (const std::uint32_t bins : {2u, 4u, 64u}) {
    const ModelCase c = plain(InputSource::direction, InputEncoding::one_blob, bins);
    OwnedBatch batch = make_batch(*c.model, directions.size(), 2);
    batch.directions = directions;
    expect_same_answers(c, batch);
    expect_finite_beyond(c, batch);
  }
}

TEST(ExtremeInputs, OfDirectionsThatAreNotUnitVectorsOnlyTheDirectionCounts) {
  for (const InputSource source : {InputSource::direction, InputSource::normal}) {
    const ModelCase c = plain(source, InputEncoding::one_blob, 4);
    const auto scaled = [&](float scale) {
      OwnedBatch batch = make_batch(*c.model, 96, 3);
      for (auto* span : {&batch.directions, &batch.normals})
        for (Float3& d : *span)
          for (float& x : d) x *= scale;
      return batch;
    };
    for (const float scale : {1e-15f, 1e-6f, 0.999f, 3.0f, 1e6f, 1e15f})
      expect_same_answers(c, scaled(scale));
    for (const float scale : {0.0f, 1e-45f, 1e-30f, 1e30f, 3e38f}) expect_finite_beyond(c, scaled(scale));
  }
}

TEST(ExtremeInputs, BarycentricsOutsideATriangleGiveTheNearestPointsAnswers) {
  for (const char* name : {"nrc", "gate_L2_stack_64", "gate_L5_per_triangle_stack_5_a_1"}) {
    const ModelCase c = find_model_case(name);
    OwnedBatch batch = make_batch(*c.model, 169, 4);
    const float values[] = {-kGreatest, -1e9f, -1.0f, -1e-5f,   -1e-7f, -1e-38f,  0.0f,
                            1e-38f,     1e-7f, 1.0f,  1.00001f, 1e9f,   kGreatest};
    for (std::size_t r = 0; r < 169; ++r) batch.barycentrics[r] = {values[r % 13], values[r / 13]};
    expect_same_answers(c, batch);
    expect_finite_beyond(c, batch);
  }
}

TEST(ExtremeInputs, PositionsOutsideTheGridGiveTheBordersAnswers) {
  for (const char* name : {"hash_F4", "hash_16_levels", "hash_tables_of_8"}) {
    const ModelCase c = find_model_case(name);
    OwnedBatch batch = make_batch(*c.model, 125, 5);
    const float values[] = {-kGreatest, -100.0f, 0.5f, 3.0f, kGreatest};
    for (std::size_t r = 0; r < 125; ++r)
      batch.positions[r] = {values[r % 5], values[r / 5 % 5], values[r / 25]};
    expect_same_answers(c, batch);
    expect_finite_beyond(c, batch);
  }
}

TEST(ExtremeInputs, GridsOfAnySizeAgreeWithTheReferenceAndInvalidBoundsAreRefused) {
  for (const float size : {1e-30f, 1e-6f, 1.0f, 1e6f, 1e30f}) {
    ModelConfig config = default_hash_config();
    config.auxiliary.clear();
    config.hash_grid.bounds_min = {-size, 0, size};
    config.hash_grid.bounds_max = {size, size, 2 * size};
    const ModelCase c = make_case(fmt::format("bounds {}", size), config);
    expect_same_answers(c, make_batch(*c.model, 96, 6));
  }
  for (const auto& [low, high] : std::vector<std::pair<float, float>>{
           {0, 0}, {1, 0}, {-kGreatest, kGreatest}, {0, std::nanf("")}, {0, HUGE_VALF}, {0, 1e-45f}}) {
    ModelConfig config = default_hash_config();
    config.hash_grid.bounds_min = {low, low, low};
    config.hash_grid.bounds_max = {high, high, high};
    EXPECT_THROW(make_model(config), BadConfiguration) << low << " " << high;
  }
}

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
