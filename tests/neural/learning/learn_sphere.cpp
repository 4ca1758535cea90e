// gatelight-learn-sphere [fp32|fp16-masters|fp16 [fp32|bf16]]: a GATE cache learns the light that leaves a
// tessellated sphere, with features stored and answers computed in these precisions. An example of how the
// library is used, and a test that it learns on every instruction set. A hash grid of the same size learns
// beside it. Prints losses and relative errors (root mean squared error over the root mean square of the
// radiance) as they fall, and ends with 1 where an error rises by more than a tenth from one line to the next
// or is not below its bound at the end.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>
#include <vector>

#include "base/random.h"
#include "neural/cpu/cpu_backend.h"
#include "neural/layout/surface_layout.h"
#include "neural/trainer.h"

namespace {

using namespace gatelight;
using namespace gatelight::neural;

constexpr std::size_t kBatch = 1024;
constexpr std::size_t kTestPoints = 4096;
constexpr std::uint64_t kSteps = 512;
// Relative error at the end. Measured, on every instruction set: 0.065 and 0.072.
constexpr double kGateBound = 0.08;
constexpr double kHashGridBound = 0.09;

// ---- the scene: radiance L(p, w) at the point p of the unit sphere into the direction w

Float3 normalized(const Float3& v) {
  const float length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

float dot(const Float3& a, const Float3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Two bands of spherical harmonics, a spot of about 15 degrees, and a highlight that depends on the
/// direction.
Float3 radiance(const Float3& p, const Float3& outgoing) {
  static const Float3 spot = normalized({1, 2, 2}), lamp = normalized({-1, 1, 0.5f});
  const float x = p[0], y = p[1], z = p[2];
  const float glow = std::exp(40.0f * (dot(p, spot) - 1.0f));
  const float facing = 2.0f * dot(lamp, p);
  const Float3 mirrored = {facing * x - lamp[0], facing * y - lamp[1], facing * z - lamp[2]};
  const float highlight = 0.6f * std::pow(std::max(dot(mirrored, outgoing), 0.0f), 12.0f);
  return {0.6f + 0.3f * y + 0.25f * x * z + 1.5f * glow + highlight,
          0.6f + 0.3f * z + 0.20f * (3 * y * y - 1) + 1.0f * glow + highlight,
          0.6f - 0.3f * x + 0.25f * (x * x - z * z) + 0.3f * glow + highlight};
}

// ---- the sphere: a cube of 6 x cells^2 squares blown up, its vertices welded

struct Sphere {
  std::vector<Float3> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

Sphere make_sphere(int cells) {
  Sphere sphere;
  const auto add_square = [&](int axis, int side, int i, int j) {
    const auto first = static_cast<std::uint32_t>(sphere.positions.size());
    for (const auto& [di, dj] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      // Whole numbers, so that squares agree on their corners to the last bit.
      std::array<int, 3> corner;
      const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
      corner[static_cast<std::size_t>(axis)] = side * cells;
      corner[u] = side * (2 * (i + di) - cells);
      corner[v] = 2 * (j + dj) - cells;
      sphere.positions.push_back(normalized(
          {static_cast<float>(corner[0]), static_cast<float>(corner[1]), static_cast<float>(corner[2])}));
    }
    sphere.triangles.push_back({first, first + 1, first + 2});
    sphere.triangles.push_back({first, first + 2, first + 3});
  };
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1})
      for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j) add_square(axis, side, i, j);
  const std::vector<std::uint32_t> welded = weld_vertices(sphere.positions);
  for (auto& triangle : sphere.triangles)
    for (std::uint32_t& vertex : triangle) vertex = welded[vertex];
  return sphere;
}

// ---- points on the sphere, with the radiance that leaves them

struct Records {
  std::vector<std::uint32_t> surfaces, triangles;
  std::vector<Float2> barycentrics;
  std::vector<Float3> positions, directions, normals;
  std::vector<float> targets;

  QueryBatch points() const {
    QueryBatch batch;
    batch.surfaces = surfaces;
    batch.triangles = triangles;
    batch.barycentrics = barycentrics;
    batch.positions = positions;
    batch.directions = directions;
    batch.normals = normals;
    batch.size = surfaces.size();
    return batch;
  }
};

Float3 direction_of(float u, float v) {
  const float z = 1.0f - 2.0f * u, r = std::sqrt(std::max(0.0f, 1.0f - z * z));
  const float phi = 2.0f * std::numbers::pi_v<float> * v;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

Records make_records(const Sphere& sphere, std::size_t count, std::uint64_t seed) {
  Records records;
  std::uint64_t counter = 0;
  const auto next = [&] { return uniform_float(seed, counter++); };
  for (std::size_t i = 0; i < count; ++i) {
    const auto triangles = static_cast<float>(sphere.triangles.size());
    const auto triangle =
        std::min(static_cast<std::uint32_t>(next() * triangles), static_cast<std::uint32_t>(triangles) - 1);
    Float2 b = {next(), next()};
    if (b[0] + b[1] > 1) b = {1 - b[0], 1 - b[1]};
    const auto& corners = sphere.triangles[triangle];
    Float3 p;
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = (1 - b[0] - b[1]) * sphere.positions[corners[0]][axis] +
                b[0] * sphere.positions[corners[1]][axis] + b[1] * sphere.positions[corners[2]][axis];
    const Float3 normal = normalized(p);
    Float3 outgoing = direction_of(next(), next());
    if (dot(outgoing, normal) < 0)
      for (float& x : outgoing) x = -x;

    records.surfaces.push_back(surface_index(0, 0));
    records.triangles.push_back(triangle);
    records.barycentrics.push_back(b);
    records.positions.push_back(p);
    records.directions.push_back(outgoing);
    records.normals.push_back(normal);
    for (const float x : radiance(normal, outgoing)) records.targets.push_back(x);
  }
  return records;
}

// ---- learning

/// Root mean squared error divided by the root mean square of the radiance.
double relative_error(const Trainer& trainer, const Records& records, QueryPrecision precision) {
  std::vector<float> answers(records.targets.size());
  trainer.query(records.points(), {.precision = precision}, answers);
  double error = 0, signal = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    error += std::pow(static_cast<double>(answers[i]) - records.targets[i], 2);
    signal += std::pow(static_cast<double>(records.targets[i]), 2);
  }
  return std::sqrt(error / signal);
}

struct Models {
  std::shared_ptr<const Model> gate, hash_grid;
};

Models make_models(const Sphere& sphere) {
  SurfaceLayout surfaces;
  surfaces.meshes = {{sphere.positions, sphere.triangles}};
  surfaces.instances = {{}};
  ModelConfig gate;
  gate.auxiliary = composite_inputs({});  // the direction
  Models models;
  models.gate = make_model(gate, surfaces);

  ModelConfig hash_grid;
  hash_grid.encoding = FeatureEncoding::hash_grid;
  hash_grid.hash_grid.bounds_min = {-1, -1, -1};
  hash_grid.hash_grid.bounds_max = {1, 1, 1};
  hash_grid.hash_grid.memory_target = models.gate->parameters.network * sizeof(float);
  hash_grid.auxiliary = composite_inputs({.direction = true, .normal = true});  // as in the paper
  models.hash_grid = make_model(hash_grid);
  return models;
}

struct Precisions {
  FeaturePrecision features = FeaturePrecision::fp32;
  QueryPrecision answers = QueryPrecision::fp32;
};

/// Prints a table for one instruction set. Returns whether all errors fell as they should.
bool learn(const Models& models, const Sphere& sphere, simd::Isa isa, const Precisions& precisions) {
  const TrainingOptions options{.precision = precisions.features};
  Trainer gate(models.gate, options, cpu::make_cpu_backend(models.gate, options, isa));
  Trainer hash_grid(models.hash_grid, options, cpu::make_cpu_backend(models.hash_grid, options, isa));
  const Records test = make_records(sphere, kTestPoints, 1);
  fmt::print("\n{}\n{:>6}  {:>10} {:>10}  {:>10} {:>10}\n", isa_name(isa), "step", "GATE loss", "error",
             "grid loss", "error");
  double gate_error = relative_error(gate, test, precisions.answers);
  double hash_grid_error = relative_error(hash_grid, test, precisions.answers);
  bool fell = true;
  const auto measure = [&](const Trainer& trainer, double& error) {
    const double now = relative_error(trainer, test, precisions.answers);
    fell = fell && now < 1.1 * error;  // false for NaN
    error = now;
  };
  fmt::print("{:>6}  {:>10} {:>10.4f}  {:>10} {:>10.4f}\n", 0, "", gate_error, "", hash_grid_error);
  for (std::uint64_t step = 1; step <= kSteps; ++step) {
    const Records records = make_records(sphere, kBatch, step + 1);
    const TrainingBatch batch{records.points(), records.targets};
    const double gate_loss = gate.train(batch).loss, hash_grid_loss = hash_grid.train(batch).loss;
    if ((step & (step - 1)) != 0) continue;
    measure(gate, gate_error);
    measure(hash_grid, hash_grid_error);
    fmt::print("{:>6}  {:>10.6f} {:>10.4f}  {:>10.6f} {:>10.4f}\n", step, gate_loss, gate_error,
               hash_grid_loss, hash_grid_error);
  }
  return fell && gate_error < kGateBound && hash_grid_error < kHashGridBound;
}

int run(const Precisions& precisions) {
  const Sphere sphere = make_sphere(4);
  const Models models = make_models(sphere);
  fmt::print("{} triangles, {} KB of features: GATE {} nodes x {}, hash grid {} entries x {}\n",
             sphere.triangles.size(), models.gate->parameters.network * sizeof(float) / 1024,
             models.gate->parameters.node_count, models.gate->parameters.features,
             models.hash_grid->parameters.node_count, models.hash_grid->parameters.features);
  bool good = true;
  for (const simd::Isa isa : simd::available_isas()) good = learn(models, sphere, isa, precisions) && good;
  if (!good) fmt::print(stderr, "gatelight-learn-sphere: an error did not fall as it should\n");
  return good ? 0 : 1;
}

}  // namespace

int main(int count, char** words) {
  const std::string_view features = count > 1 ? words[1] : "fp32", answers = count > 2 ? words[2] : "fp32";
  Precisions precisions;
  if (features == "fp16-masters") precisions.features = FeaturePrecision::fp16_masters;
  if (features == "fp16") precisions.features = FeaturePrecision::fp16;
  if (answers == "bf16") precisions.answers = QueryPrecision::bf16;
  return run(precisions);
}
