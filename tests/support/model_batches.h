#pragma once
// Batches of random records for any model, with the result that a backend must give for each record.

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include "neural/model/batch.h"
#include "neural/model/model.h"
#include "tests/support/counter_random.h"

namespace gatelight::neural::testing {

enum class Fate : std::uint8_t { accepted, clipped, rejected, unstored };

/// `fates` has the result that a backend must give for each record.
struct OwnedBatch {
  std::vector<std::uint32_t> surfaces, triangles;
  std::vector<Float2> barycentrics;
  std::vector<Float3> positions, directions, normals, albedos;
  std::vector<float> roughnesses;
  std::vector<float> targets;
  std::vector<Fate> fates;

  QueryBatch points() const {
    return {surfaces, triangles, barycentrics, positions,   directions,
            normals,  albedos,   roughnesses,  fates.size()};
  }
  TrainingBatch training() const { return {points(), targets}; }
  std::size_t size() const { return fates.size(); }
  std::uint64_t count(Fate fate) const {
    return static_cast<std::uint64_t>(std::count(fates.begin(), fates.end(), fate));
  }
};

struct BatchOptions {
  /// Shares of the records that get NaN or infinity, lie where nothing is stored, or have a target beyond
  /// 1e9 (finite). Without gate nothing is unstored.
  float nonfinite = 0, unstored = 0, beyond = 0;
  /// Share of barycentrics at corners, on edges and slightly outside: there the precision decides whether a
  /// weight is 0 or 1e-9, and with it whether a node is touched.
  float border = 0;
  float crowded = 0.25f;  ///< share of records on one triangle, so that gradients add up
};

namespace detail {

inline void spoil(OwnedBatch& batch, std::size_t record, std::uint32_t outputs, Random& random) {
  constexpr float kBad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                            -std::numeric_limits<float>::infinity()};
  const float bad = kBad[random.below(3)];
  std::vector<float*> places;
  for (std::uint32_t o = 0; o < outputs; ++o) places.push_back(&batch.targets[record * outputs + o]);
  if (!batch.barycentrics.empty())
    for (float& value : batch.barycentrics[record]) places.push_back(&value);
  for (auto* span : {&batch.positions, &batch.directions, &batch.normals, &batch.albedos})
    if (!span->empty())
      for (float& value : (*span)[record]) places.push_back(&value);
  if (!batch.roughnesses.empty()) places.push_back(&batch.roughnesses[record]);
  *places[random.below(static_cast<std::uint32_t>(places.size()))] = bad;
}

}  // namespace detail

/// Records of points at which the model can be queried; spans that it does not read stay empty.
inline OwnedBatch make_batch(const Model& model, std::size_t size, std::uint64_t seed,
                             const BatchOptions& options = {}) {
  OwnedBatch batch;
  Random random{seed};
  const ModelConfig& config = model.config;
  const bool gate = config.encoding == FeatureEncoding::gate;
  const auto uses = [&](InputSource source) { return uses_input(config, source); };
  std::vector<std::uint32_t> stored, bare;
  for (std::uint32_t s = 0; gate && s < model.gate.surfaces.size(); ++s)
    (model.gate.levels[s * model.gate.stack].resolution > 0 ? stored : bare).push_back(s);

  for (std::size_t r = 0; r < size; ++r) {
    const float draw = random.unit();
    Fate fate = Fate::accepted;
    if (draw < options.nonfinite)
      fate = Fate::rejected;
    else if (draw < options.nonfinite + options.unstored)
      fate = gate ? Fate::unstored : Fate::accepted;
    else if (draw < options.nonfinite + options.unstored + options.beyond)
      fate = Fate::clipped;
    batch.fates.push_back(fate);

    if (gate) {
      std::uint32_t surface = stored[random.below(static_cast<std::uint32_t>(stored.size()))];
      std::uint32_t triangle = random.below(model.gate.surfaces[surface].triangle_count);
      if (random.unit() < options.crowded) {
        surface = stored[0];
        triangle = 0;
      }
      if (fate == Fate::unstored) {
        const std::uint32_t way = random.below(bare.empty() ? 2 : 3);
        if (way == 0) triangle = model.gate.surfaces[surface].triangle_count + random.below(1000);
        if (way == 1)
          surface = static_cast<std::uint32_t>(model.gate.surfaces.size()) + random.below(0x7fffffffu);
        if (way == 2) {
          surface = bare[random.below(static_cast<std::uint32_t>(bare.size()))];
          triangle = 0;
        }
      }
      Float2 b = {random.unit(), random.unit()};
      if (b[0] + b[1] > 1) b = {1 - b[0], 1 - b[1]};
      if (random.unit() < options.border) {
        constexpr Float2 kBorders[] = {
            {0, 0},       {1, 0},          {0, 1},         {0.5f, 0},           {0, 0.5f},
            {0.5f, 0.5f}, {-1e-5f, 0.25f}, {0.5f, -2e-6f}, {0.75f, 0.2500001f}, {1e-40f, 1e-42f}};
        b = kBorders[random.below(static_cast<std::uint32_t>(std::size(kBorders)))];
      }
      batch.surfaces.push_back(surface);
      batch.triangles.push_back(triangle);
      batch.barycentrics.push_back(b);
    }
    if (uses(InputSource::position)) {
      Float3 position;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float low = config.hash_grid.bounds_min[axis], high = config.hash_grid.bounds_max[axis];
        position[axis] = random.between(low - 0.05f * (high - low), high + 0.05f * (high - low));
      }
      batch.positions.push_back(position);
    }
    if (uses(InputSource::direction)) batch.directions.push_back(random.direction());
    if (uses(InputSource::normal)) batch.normals.push_back(random.direction());
    if (uses(InputSource::albedo)) batch.albedos.push_back({random.unit(), random.unit(), random.unit()});
    if (uses(InputSource::roughness)) batch.roughnesses.push_back(random.unit());
    for (std::uint32_t o = 0; o < config.mlp.outputs; ++o)
      batch.targets.push_back(random.between(0.1f, 2.0f));
    if (fate == Fate::rejected) detail::spoil(batch, r, config.mlp.outputs, random);
    if (fate == Fate::clipped)
      batch.targets[r * config.mlp.outputs + random.below(config.mlp.outputs)] =
          random.unit() < 0.5f ? 4e9f : -3e38f;
  }
  return batch;
}

/// The batch without the records that are to be rejected or are unstored.
inline OwnedBatch good_records(const OwnedBatch& batch) {
  OwnedBatch good;
  const std::size_t outputs = batch.size() == 0 ? 0 : batch.targets.size() / batch.size();
  const auto copy = [](auto& to, const auto& from, std::size_t r) {
    if (!from.empty()) to.push_back(from[r]);
  };
  for (std::size_t r = 0; r < batch.size(); ++r) {
    if (batch.fates[r] == Fate::rejected || batch.fates[r] == Fate::unstored) continue;
    copy(good.surfaces, batch.surfaces, r);
    copy(good.triangles, batch.triangles, r);
    copy(good.barycentrics, batch.barycentrics, r);
    copy(good.positions, batch.positions, r);
    copy(good.directions, batch.directions, r);
    copy(good.normals, batch.normals, r);
    copy(good.albedos, batch.albedos, r);
    copy(good.roughnesses, batch.roughnesses, r);
    for (std::size_t o = 0; o < outputs; ++o) good.targets.push_back(batch.targets[r * outputs + o]);
    good.fates.push_back(batch.fates[r]);
  }
  return good;
}

}  // namespace gatelight::neural::testing
