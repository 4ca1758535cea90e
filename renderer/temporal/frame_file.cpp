#include "renderer/temporal/frame_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include "base/file/content_digest.h"
#include "base/to_number.h"

namespace gatelight::renderer {
namespace {

constexpr const char* kFrameFormat = "gatelight-frame";
constexpr int kFrameVersion = 2;
constexpr const char* kFrameColor = "frame.color";
constexpr const char* kFrameSamples = "frame.samples";
constexpr const char* kNumber = "frame.number";
constexpr const char* kLayoutSeconds = "frame.layout_seconds";
constexpr const char* kExposure = "frame.exposure";

template <class Number>
std::optional<Number> number_of(const SafetensorsReader& file, const char* key) {
  const auto found = file.metadata().find(key);
  if (found == file.metadata().end()) return std::nullopt;
  const std::string& text = found->second;
  const std::optional<Number> value = to_number<Number>(text);
  bool good = value.has_value();
  if constexpr (std::is_floating_point_v<Number>) good = good && std::isfinite(*value);
  if (!good) file.fail(fmt::format("{}: '{}', expected a finite number", key, text));
  return value;
}

std::array<std::uint64_t, 3> shape_of(int width, int height, int channels) {
  return {static_cast<std::uint64_t>(height), static_cast<std::uint64_t>(width),
          static_cast<std::uint64_t>(channels)};
}

}  // namespace

OtherContent frame_content(const FrameStatus& status, const FrameLight& light) {
  OtherContent content;
  Metadata& metadata = content.metadata;
  if (status.frame) metadata[kNumber] = fmt::format("{}", *status.frame);
  metadata[kLayoutSeconds] = fmt::format("{}", status.layout_seconds);
  if (status.exposure) metadata[kExposure] = fmt::format("{}", *status.exposure);
  if (light.empty()) return content;
  const auto add = [&](const char* name, const std::vector<float>& values, int channels) {
    const auto shape = shape_of(light.width, light.height, channels);
    content.tensors.push_back(
        {name, TensorType::f32, {shape.begin(), shape.end()}, std::as_bytes(std::span(values))});
  };
  add(kFrameColor, light.color, 3);
  add(kFrameSamples, light.samples, 1);
  return content;
}

void write_frame_file(const std::filesystem::path& path, const FrameStatus& status, const FrameLight& light,
                      const SceneFingerprint& scene) {
  OtherContent content = frame_content(status, light);
  content.metadata["format"] = kFrameFormat;
  content.metadata["version"] = fmt::format("{}", kFrameVersion);
  add_texts(content.metadata, kScene, scene);
  content.metadata[kDigestKey] = content_digest(content.tensors, content.metadata);
  write_safetensors(path, content.tensors, content.metadata);
}

std::set<std::string> frame_tensors() {
  return {kFrameColor, kFrameSamples};
}

FrameFile::FrameFile(const std::filesystem::path& path) : file_(path) {
  const auto format = file_.metadata().find("format");
  const bool alone = format != file_.metadata().end() && format->second == kFrameFormat;
  if (alone) neural::expect_version(file_, kFrameVersion);
  const std::optional<double> seconds = number_of<double>(file_, kLayoutSeconds);
  status_ = {.frame = number_of<int>(file_, kNumber),
             .layout_seconds = seconds.value_or(0.0),
             .exposure = number_of<float>(file_, kExposure),
             .of_animation = seconds.has_value()};
}

FrameLight FrameFile::read_light(const SceneFingerprint& scene, int width, int height) {
  FrameLight light{.width = width, .height = height};
  const std::vector<std::string> names = file_.names();
  if (std::find(names.begin(), names.end(), kFrameColor) == names.end()) return {};
  expect_scene(file_, scene);
  const auto read = [&](const char* name, std::vector<float>& values, int channels) {
    const auto shape = shape_of(width, height, channels);
    file_.expect_shape(name, TensorType::f32, shape);
    values.resize(shape[0] * shape[1] * shape[2]);
    file_.read(name, TensorType::f32, shape, std::as_writable_bytes(std::span(values)));
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i]))
        file_.fail(
            fmt::format("tensor '{}': element {} is {}, expected a finite number", name, i, values[i]));
    }
  };
  read(kFrameColor, light.color, 3);
  read(kFrameSamples, light.samples, 1);
  return light;
}

}  // namespace gatelight::renderer
