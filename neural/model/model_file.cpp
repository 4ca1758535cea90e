#include "neural/model/model_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <set>
#include <span>
#include <vector>

#include "base/errors.h"
#include "base/file/content_digest.h"
#include "base/file/safetensors.h"
#include "base/half.h"
#include "neural/model/checks.h"
#include "neural/model/model_description.h"

namespace gatelight::neural {

namespace {

using nlohmann::ordered_json;

constexpr const char* kFormat = "gatelight-cache";
constexpr int kVersion = 2;

/// The part of the flat parameters that one tensor holds.
struct Part {
  std::string name;
  std::uint64_t offset = 0;
  std::uint64_t count = 0;
  std::vector<std::uint64_t> shape;
  bool features = false;
};

std::vector<Part> parts(const ParameterLayout& layout) {
  std::vector<Part> parts;
  if (layout.network > 0)
    parts.push_back({"features", 0, layout.network, {layout.node_count, layout.features}, true});
  for (std::size_t i = 0; i < layout.layers.size(); ++i) {
    const LayerLayout& layer = layout.layers[i];
    parts.push_back({fmt::format("layers.{}.weight", i),
                     layer.weights,
                     std::uint64_t{layer.inputs} * layer.outputs,
                     {layer.outputs, layer.inputs}});
    if (layout.biases)
      parts.push_back({fmt::format("layers.{}.bias", i), layer.biases, layer.outputs, {layer.outputs}});
  }
  return parts;
}

/// The arrays over all parameters.
struct Array {
  const char* prefix;
  std::vector<float> ModelState::*values;
};

constexpr Array kArrays[] = {{"", &ModelState::parameters},
                             {"average.", &ModelState::averages},
                             {"first_moment.", &ModelState::first_moments},
                             {"second_moment.", &ModelState::second_moments}};

std::string tensor_name(const Array& array, const Part& part) {
  return fmt::format("{}{}", array.prefix, part.name);
}

/// The same conditions as in check_state_numbers().
bool is_sound(const Array& array, float value) {
  return std::isfinite(value) && (array.values != &ModelState::second_moments || value >= 0.0f);
}

/// Averages are left out if they are not kept: they equal the parameters then.
bool is_stored(const Array& array, const Part& part, const TrainingOptions& options) {
  if (array.values != &ModelState::averages) return true;
  return part.features ? options.average.features : options.average.network;
}

bool is_half(const Array& array, const Part& part, const TrainingOptions& options) {
  return part.features && array.values == &ModelState::parameters &&
         options.precision == FeaturePrecision::fp16;
}

template <class T>
TensorView view(const std::string& name, TensorType type, const std::vector<std::uint64_t>& shape,
                std::span<const T> values) {
  return {name, type, shape, std::as_bytes(values)};
}

std::vector<std::uint16_t> to_halves(std::span<const float> values) {
  std::vector<std::uint16_t> halves(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    halves[i] = float_to_half(values[i]);
    if (std::bit_cast<std::uint32_t>(half_to_float(halves[i])) != std::bit_cast<std::uint32_t>(values[i]))
      throw BadConfiguration(
          fmt::format("features[{}] is {}, expected a number that fp16 holds", i, values[i]));
  }
  return halves;
}

/// Parses a metadata text as a JSON object.
ordered_json description(const SafetensorsReader& file, const std::string& key) {
  const auto found = file.metadata().find(key);
  if (found == file.metadata().end()) file.fail(fmt::format("metadata '{}' is missing", key));
  ordered_json value = ordered_json::parse(found->second, nullptr, false);
  if (!value.is_object()) file.fail(fmt::format("metadata '{}' is no JSON object", key));
  for (const auto& [name, entry] : value.items()) {
    if (!entry.is_primitive())
      file.fail(fmt::format("metadata '{}': '{}' is no number and no text", key, name));
  }
  return value;
}

void expect_same_model(const SafetensorsReader& file, const Model& model, const TrainingOptions& options) {
  std::string differences = list_differences(description(file, "network"), describe_network(model));
  if (!differences.empty()) file.fail(fmt::format("it has another configuration: {}", differences));
  differences = list_differences(description(file, "arrays"), describe_arrays(options));
  if (!differences.empty()) file.fail(fmt::format("it was trained with other options: {}", differences));
  const auto digest = file.metadata().find("layout_digest");
  if (digest == file.metadata().end() || digest->second != layout_digest(model)) {
    differences = list_differences(description(file, "layout"), describe_layout(model));
    file.fail(fmt::format(
        "it is of another layout: {}",
        differences.empty() ? "the surfaces differ, although the options are equal" : differences));
  }
}

void read_values(SafetensorsReader& file, const Array& array, const Part& part, bool half,
                 std::span<float> out) {
  const std::string name = tensor_name(array, part);
  if (half) {
    std::vector<std::uint16_t> halves(out.size());
    file.read(name, TensorType::f16, part.shape, std::as_writable_bytes(std::span(halves)));
    std::transform(halves.begin(), halves.end(), out.begin(), half_to_float);
  } else {
    file.read(name, TensorType::f32, part.shape, std::as_writable_bytes(out));
  }
  const auto bad =
      std::find_if_not(out.begin(), out.end(), [&](float value) { return is_sound(array, value); });
  if (bad != out.end())
    file.fail(fmt::format(
        "tensor '{}': element {} is {}, expected {}", name, bad - out.begin(), *bad,
        array.values == &ModelState::second_moments ? "a finite number from 0 on" : "a finite number"));
}

}  // namespace

void expect_text(const SafetensorsReader& file, const std::string& key, const std::string& what,
                 const std::string& expected) {
  const auto found = file.metadata().find(key);
  const std::string text = found == file.metadata().end() ? "nothing" : fmt::format("'{}'", found->second);
  if (text != fmt::format("'{}'", expected))
    file.fail(fmt::format("{}: file {}, expected '{}'", what, text, expected));
}

void expect_version(SafetensorsReader& file, int version) {
  expect_text(file, "version", "format version", fmt::format("{}", version));
  expect_digest(file);
}

void expect_model(const SafetensorsReader& file, const Model& model, const TrainingOptions& options) {
  expect_same_model(file, model, options);
  for (const Array& array : kArrays) {
    for (const Part& part : parts(model.parameters)) {
      if (!is_stored(array, part, options)) continue;
      const TensorType type = is_half(array, part, options) ? TensorType::f16 : TensorType::f32;
      file.expect_shape(tensor_name(array, part), type, part.shape);
    }
  }
}

void expect_no_other_tensors(const SafetensorsReader& file, const Model& model,
                             const TrainingOptions& options, std::set<std::string> others) {
  others.insert({"node_steps", "triangle_steps", "steps"});
  for (const Array& array : kArrays) {
    for (const Part& part : parts(model.parameters)) {
      if (is_stored(array, part, options)) others.insert(tensor_name(array, part));
    }
  }
  for (const std::string& name : file.names()) {
    if (!others.contains(name)) file.fail(fmt::format("tensor '{}' is not of this model", name));
  }
}

ModelContent make_model_content(const Model& model, const TrainingOptions& options, const ModelState& state) {
  check_state(model, options, state);
  ModelContent content;
  for (const Array& array : kArrays) {
    for (const Part& part : parts(model.parameters)) {
      if (!is_stored(array, part, options)) continue;
      const std::span values = std::span<const float>(state.*array.values).subspan(part.offset, part.count);
      const std::string name = tensor_name(array, part);
      if (is_half(array, part, options)) {
        content.halves = to_halves(values);
        content.tensors.push_back(view<std::uint16_t>(name, TensorType::f16, part.shape, content.halves));
      } else {
        content.tensors.push_back(view(name, TensorType::f32, part.shape, values));
      }
    }
  }
  content.tensors.push_back(
      view<std::uint32_t>("node_steps", TensorType::u32, {state.node_steps.size()}, state.node_steps));
  content.tensors.push_back(view<std::uint32_t>("triangle_steps", TensorType::u32,
                                                {state.triangle_steps.size()}, state.triangle_steps));
  content.tensors.push_back(view("steps", TensorType::u64, {1}, std::span(&state.steps, 1)));
  content.metadata["network"] = describe_network(model).dump();
  content.metadata["layout"] = describe_layout(model).dump();
  content.metadata["layout_digest"] = layout_digest(model);
  content.metadata["arrays"] = describe_arrays(options).dump();
  content.metadata["training"] = describe_training(options).dump();
  return content;
}

ModelState read_model_content(SafetensorsReader& file, const Model& model, const TrainingOptions& options) {
  expect_model(file, model, options);
  // This gives all arrays the right size; averages that are not stored are set below.
  ModelState state = initial_state(model, options);
  for (const Array& array : kArrays) {
    for (const Part& part : parts(model.parameters)) {
      const std::span out = std::span(state.*array.values).subspan(part.offset, part.count);
      if (is_stored(array, part, options)) {
        read_values(file, array, part, is_half(array, part, options), out);
      } else {
        const std::span values = std::span(state.parameters).subspan(part.offset, part.count);
        std::copy(values.begin(), values.end(), out.begin());
      }
    }
  }
  const auto read_counts = [&](const char* name, std::vector<std::uint32_t>& counts) {
    const std::uint64_t shape[] = {counts.size()};
    file.read(name, TensorType::u32, shape, std::as_writable_bytes(std::span(counts)));
  };
  read_counts("node_steps", state.node_steps);
  read_counts("triangle_steps", state.triangle_steps);
  const std::uint64_t one[] = {1};
  file.read("steps", TensorType::u64, one, std::as_writable_bytes(std::span(&state.steps, 1)));
  if (state.steps >> 63 != 0)
    file.fail(fmt::format("tensor 'steps': {}, expected less than 2^63", state.steps));
  return state;
}

void write_model_file(const std::filesystem::path& path, const Model& model, const TrainingOptions& options,
                      const ModelState& state, const std::string& fingerprint) {
  ModelContent content = make_model_content(model, options, state);
  content.metadata["format"] = kFormat;
  content.metadata["version"] = fmt::format("{}", kVersion);
  content.metadata["fingerprint"] = fingerprint;
  content.metadata[kDigestKey] = content_digest(content.tensors, content.metadata);
  write_safetensors(path, content.tensors, content.metadata);
}

ModelState read_model_file(const std::filesystem::path& path, const Model& model,
                           const TrainingOptions& options, const std::string& fingerprint) {
  SafetensorsReader file(path);
  expect_text(file, "format", "format", kFormat);
  expect_version(file, kVersion);
  ModelState state = read_model_content(file, model, options);
  expect_text(file, "fingerprint", "fingerprint", fingerprint);
  expect_no_other_tensors(file, model, options);
  return state;
}

}  // namespace gatelight::neural
