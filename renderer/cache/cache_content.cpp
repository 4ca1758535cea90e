#include "renderer/cache/cache_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>

namespace gatelight::renderer {
namespace {

constexpr const char* kSides = "renderer.sides";
constexpr const char* kSpacingScales = "renderer.spacing_scales";
constexpr const char* kScales = "renderer.scales";
constexpr const char* kTriangleCounts = "renderer.triangle_counts";
constexpr const char* kSteps = "renderer.steps";
constexpr const char* kPictureSamples = "renderer.samples";

template <class Values>
void read_positive(SafetensorsReader& file, const char* name, Values& values) {
  read_array(file, name, TensorType::f32, values);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!(values[i] > 0.0f) || !std::isfinite(values[i]))
      file.fail(fmt::format("tensor '{}': element {} is {}, expected a finite number above zero", name, i,
                            values[i]));
  }
}

}  // namespace

void fill_cache_content(CacheContent& content, const neural::Model& model,
                        const neural::TrainingOptions& options, const CacheState& state) {
  content.model = neural::make_model_content(model, options, state.model);
  const CacheSetup& setup = state.setup;
  content.sides.clear();
  for (const neural::Sides sides : setup.sides) content.sides.push_back(static_cast<std::uint32_t>(sides));
  content.scales = {setup.node_spacing, setup.target_scale, setup.records_per_path,
                    setup.records_per_short_path};
  content.spacing_scales = setup.spacing_scales;
  content.tensors = content.model.tensors;
  const auto add = [&](const char* name, TensorType type, const auto& values) {
    content.tensors.push_back(view_array(name, type, values));
  };
  add(kSides, TensorType::u32, content.sides);
  add(kSpacingScales, TensorType::f32, content.spacing_scales);
  add(kScales, TensorType::f32, content.scales);
  add(kTriangleCounts, TensorType::u32, state.triangle_counts);
  add(kSteps, TensorType::u64, std::span(&state.steps, 1));
  if (state.samples > 0) add(kPictureSamples, TensorType::u64, std::span(&state.samples, 1));
}

CacheSetup read_cache_setup(SafetensorsReader& file) {
  // The length is untrusted, but the file has as many elements, so it takes no more memory than the file.
  std::vector<std::uint32_t> sides(file.length(kSides, TensorType::u32));
  read_array(file, kSides, TensorType::u32, sides);
  CacheSetup setup;
  setup.sides.reserve(sides.size());
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (sides[i] > static_cast<std::uint32_t>(neural::Sides::both))
      file.fail(fmt::format("tensor '{}': element {} is {}, expected 0 to 3", kSides, i, sides[i]));
    setup.sides.push_back(static_cast<neural::Sides>(sides[i]));
  }
  setup.spacing_scales.resize(sides.size());
  read_positive(file, kSpacingScales, setup.spacing_scales);
  std::array<float, 4> scales{};
  read_positive(file, kScales, scales);
  std::tie(setup.node_spacing, setup.target_scale, setup.records_per_path, setup.records_per_short_path) =
      std::tuple_cat(scales);
  // Scouting keeps this bound. The number of paths of a step follows from it, so a file must not set it
  // arbitrarily low.
  for (const float records : {setup.records_per_path, setup.records_per_short_path}) {
    if (records < kMinRecordsPerPath)
      file.fail(fmt::format("tensor '{}': {} records of a path, expected at least 1/64", kScales, records));
  }
  return setup;
}

CacheState read_cache_state(SafetensorsReader& file, const neural::Model& model,
                            const neural::TrainingOptions& options, std::set<std::string> others) {
  CacheState state;
  state.setup = read_cache_setup(file);
  state.model = neural::read_model_content(file, model, options);
  state.triangle_counts.resize(file.length(kTriangleCounts, TensorType::u32));
  read_array(file, kTriangleCounts, TensorType::u32, state.triangle_counts);
  read_array(file, kSteps, TensorType::u64, std::span(&state.steps, 1));
  if (state.steps >> 31 != 0)
    file.fail(fmt::format("tensor '{}': {}, expected less than 2^31", kSteps, state.steps));
  const std::vector<std::string> names = file.names();
  if (std::find(names.begin(), names.end(), kPictureSamples) != names.end())
    read_array(file, kPictureSamples, TensorType::u64, std::span(&state.samples, 1));
  if (state.samples >> 56 != 0)
    file.fail(fmt::format("tensor '{}': {}, expected less than 2^56", kPictureSamples, state.samples));
  others.insert({kSides, kSpacingScales, kScales, kTriangleCounts, kSteps, kPictureSamples});
  neural::expect_no_other_tensors(file, model, options, std::move(others));
  return state;
}

}  // namespace gatelight::renderer
