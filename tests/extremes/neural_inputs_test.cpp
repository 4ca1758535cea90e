// Inputs: points at borders and beyond, directions that are not unit vectors.

#include "base/errors.h"
#include "tests/extremes/fast_backends.h"

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

}  // namespace
}  // namespace gatelight::neural
