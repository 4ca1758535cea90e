#include "bench/neural_fixture.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "base/random.h"
#include "neural/layout/vector3.h"

namespace gatelight::bench {

namespace {

using neural::Float2;
using neural::Float3;

constexpr std::uint32_t kColumns = NeuralSurface::kColumns;
constexpr std::uint32_t kRows = NeuralSurface::kRows;
constexpr std::uint32_t kBatches = 8;
constexpr float kTwoPi = 2.0f * std::numbers::pi_v<float>;

Float3 normalize(const neural::Double3& a) {
  const double scale = 1.0 / neural::length(a);
  return {static_cast<float>(scale * a[0]), static_cast<float>(scale * a[1]),
          static_cast<float>(scale * a[2])};
}

Float3 torus_point(std::uint32_t column, std::uint32_t row) {
  const float u = kTwoPi * static_cast<float>(column) / kColumns;
  const float v = kTwoPi * static_cast<float>(row) / kRows;
  const float minor = 1.0f + 0.05f * std::sin(12.0f * u) * std::sin(7.0f * v);
  const float ring = 3.0f + minor * std::cos(v);
  return {ring * std::cos(u), ring * std::sin(u), minor * std::sin(v)};
}

NeuralSurface make_surface() {
  NeuralSurface surface;
  surface.bounds_min.fill(1e9f);
  surface.bounds_max.fill(-1e9f);
  for (std::uint32_t row = 0; row < kRows; ++row) {
    for (std::uint32_t column = 0; column < kColumns; ++column) {
      const Float3 p = torus_point(column, row);
      surface.positions.push_back(p);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        surface.bounds_min[axis] = std::min(surface.bounds_min[axis], p[axis]);
        surface.bounds_max[axis] = std::max(surface.bounds_max[axis], p[axis]);
      }
      const std::uint32_t right = (column + 1) % kColumns, above = (row + 1) % kRows;
      const std::uint32_t a = row * kColumns + column, b = row * kColumns + right;
      const std::uint32_t c = above * kColumns + right, d = above * kColumns + column;
      surface.triangles.push_back({a, b, c});
      surface.triangles.push_back({a, c, d});
    }
  }
  return surface;
}

/// The random numbers of one point. They do not depend on the order in which points are made.
struct PointRandom {
  std::uint64_t key;
  std::uint64_t counter;
  float next() { return uniform_float(key, counter++); }
};

void set_point(NeuralPoints& points, std::size_t i, std::uint32_t triangle, const Float2& b,
               const Float3& direction, PointRandom& random) {
  const NeuralSurface& surface = neural_surface();
  const auto& corners = surface.triangles[triangle];
  const Float3 &p0 = surface.positions[corners[0]], &p1 = surface.positions[corners[1]],
               &p2 = surface.positions[corners[2]];
  Float3 position;
  for (std::size_t axis = 0; axis < 3; ++axis)
    position[axis] = p0[axis] * (1 - b[0] - b[1]) + p1[axis] * b[0] + p2[axis] * b[1];
  points.surfaces[i] = neural::surface_index(0, 0);
  points.triangles[i] = triangle;
  points.barycentrics[i] = b;
  points.positions[i] = position;
  points.directions[i] = direction;
  points.normals[i] = normalize(neural::area_vector({surface.positions, surface.triangles}, corners));
  points.albedos[i] = {0.5f + 0.3f * std::sin(position[0]), 0.5f, 0.5f + 0.3f * std::cos(position[1])};
  for (std::size_t channel = 0; channel < 3; ++channel) points.targets[3 * i + channel] = random.next();
}

/// Puts the pixel at its place in its quad. The quad's diagonal goes from corner (0,0) to (1,1).
void set_pixel(NeuralPoints& points, std::size_t i, std::uint32_t x, std::uint32_t y, std::uint32_t patch,
               PointRandom& random) {
  const std::uint32_t column = (x / 2 + 137 * patch) % kColumns, row = (y / 2 + 61 * patch) % kRows;
  const float u = (static_cast<float>(x % 2) + random.next()) / 2,
              v = (static_cast<float>(y % 2) + random.next()) / 2;
  const std::uint32_t quad = row * kColumns + column;
  const Float3 direction = normalize({x / 1000.0 - 0.5, y / 1000.0 - 0.5, 1.0});
  // Corners (0,0), (1,0), (1,1) below the diagonal; (0,0), (1,1), (0,1) above.
  const bool below = u >= v;
  set_point(points, i, 2 * quad + (below ? 0 : 1), below ? Float2{u - v, v} : Float2{u, v - u}, direction,
            random);
}

void set_random(NeuralPoints& points, std::size_t i, bool sorted, PointRandom& random) {
  const auto count = static_cast<std::uint32_t>(neural_surface().triangles.size());
  const float place =
      sorted ? (static_cast<float>(i) + random.next()) / static_cast<float>(points.size()) : random.next();
  const auto triangle = std::min(static_cast<std::uint32_t>(place * static_cast<float>(count)), count - 1);
  Float2 b = {random.next(), random.next()};
  if (b[0] + b[1] > 1) b = {1 - b[0], 1 - b[1]};
  const float z = 2 * random.next() - 1, phi = kTwoPi * random.next(), r = std::sqrt(1 - z * z);
  set_point(points, i, triangle, b, {r * std::cos(phi), r * std::sin(phi), z}, random);
}

}  // namespace

const NeuralSurface& neural_surface() {
  static const NeuralSurface surface = make_surface();
  return surface;
}

std::string case_name(const NeuralCase& which) {
  const std::string cache = which.cache == Cache::nrc ? "nrc" : "nao";
  return cache + (which.encoding == Encoding::gate ? "/gate" : "/hashgrid");
}

neural::ModelConfig neural_config(const NeuralCase& which) {
  const bool nrc = which.cache == Cache::nrc;
  neural::ModelConfig config;
  config.mlp.outputs = nrc ? 3 : 1;
  if (nrc) config.auxiliary = {{neural::InputSource::direction, neural::InputEncoding::one_blob, 8}};
  if (which.encoding == Encoding::gate) {
    config.gate.features = nrc ? 8 : 2;
    config.gate.stack = {2, 1};
    config.gate.rule = neural::ResolutionRule::fixed;
    config.gate.cluster = false;
    return config;
  }
  config.encoding = neural::FeatureEncoding::hash_grid;
  config.hash_grid.memory_target =
      neural_model({which.cache, Encoding::gate})->parameters.network * sizeof(float);
  config.hash_grid.bounds_min = neural_surface().bounds_min;
  config.hash_grid.bounds_max = neural_surface().bounds_max;
  if (nrc) {
    config.auxiliary.push_back({neural::InputSource::normal, neural::InputEncoding::one_blob, 4});
    config.auxiliary.push_back({neural::InputSource::albedo, neural::InputEncoding::identity, 0});
  }
  return config;
}

std::shared_ptr<const neural::Model> neural_model(const NeuralCase& which) {
  static std::map<std::string, std::shared_ptr<const neural::Model>> models;
  std::shared_ptr<const neural::Model>& model = models[case_name(which)];
  if (model == nullptr) {
    const NeuralSurface& surface = neural_surface();
    neural::SurfaceLayout layout;
    layout.meshes.push_back({surface.positions, surface.triangles});
    layout.instances.emplace_back();
    model = neural::make_model(neural_config(which), layout);
  }
  return model;
}

neural::QueryBatch NeuralPoints::query_batch() const {
  return {.surfaces = surfaces,
          .triangles = triangles,
          .barycentrics = barycentrics,
          .positions = positions,
          .directions = directions,
          .normals = normals,
          .albedos = albedos,
          .size = size()};
}

std::string order_name(Order order) {
  return order == Order::coherent ? "coherent" : order == Order::random ? "random" : "random_sorted";
}

NeuralPoints make_points(Order order, std::uint32_t width, std::uint32_t height, std::uint32_t patch) {
  const std::size_t count = std::size_t{width} * height;
  NeuralPoints points;
  for (auto* numbers : {&points.surfaces, &points.triangles}) numbers->resize(count);
  for (auto* vectors : {&points.positions, &points.directions, &points.normals, &points.albedos})
    vectors->resize(count);
  points.barycentrics.resize(count);
  points.targets.resize(3 * count);
  neural_surface();
  tbb::parallel_for(std::uint32_t{0}, height, [&](std::uint32_t y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const std::size_t i = std::size_t{y} * width + x;
      PointRandom random{1000u + patch, 8 * i};
      if (order == Order::coherent) {
        set_pixel(points, i, x, y, patch, random);
      } else {
        set_random(points, i, order == Order::sorted, random);
      }
    }
  });
  return points;
}

const std::vector<NeuralPoints>& training_points(Order order) {
  static std::map<Order, std::vector<NeuralPoints>> all;
  std::vector<NeuralPoints>& batches = all[order];
  for (auto patch = static_cast<std::uint32_t>(batches.size()); patch < kBatches; ++patch)
    batches.push_back(make_points(order, kBatchWidth, kBatchHeight, patch));
  return batches;
}

std::vector<float> training_targets(const NeuralPoints& points, std::uint32_t outputs) {
  std::vector<float> targets;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::uint32_t o = 0; o < outputs; ++o) targets.push_back(points.targets[3 * i + o]);
  return targets;
}

const NeuralPoints& query_points(Order order) {
  static std::map<Order, NeuralPoints> all;
  const auto found = all.find(order);
  return found != all.end() ? found->second : all[order] = make_points(order, 1920, 1080, 0);
}

}  // namespace gatelight::bench
