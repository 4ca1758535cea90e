#include "apps/view/pixel_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/errors.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;
using renderer::Aov;
using renderer::Layer;

/// JSON has no numbers that are not finite.
ordered_json finite(float value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json values_at(const Layer& layer, std::size_t pixel) {
  ordered_json values = ordered_json::array();
  const std::size_t channels = layer.channels.size();
  for (std::size_t c = 0; c < channels; ++c) values.push_back(finite(layer.values[pixel * channels + c]));
  return values;
}

}  // namespace

ordered_json pixel_report(const renderer::Picture& picture, const SceneOutline* outline, double x, double y) {
  if (!(x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 1.0))
    throw BadOption({"x", fmt::format("{},{}", x, y), "", "a place in the picture, 0 to 1"});
  const int column = std::min(static_cast<int>(x * picture.width), picture.width - 1);
  const int row = std::min(static_cast<int>(y * picture.height), picture.height - 1);
  const std::size_t pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                            static_cast<std::size_t>(column);
  ordered_json json{{"x", column}, {"y", row}};
  ordered_json layers;
  for (const Layer& layer : picture.layers)
    layers[layer.name.empty() ? "radiance" : layer.name] = values_at(layer, pixel);
  json["layers"] = layers;
  const Layer* instances = picture.find(renderer::enum_name(Aov::instance_id));
  const Layer* positions = picture.find(renderer::enum_name(Aov::position));
  if (!outline || !instances || !positions) return json;
  const float number = instances->values[pixel];
  if (!(number >= 0.0f) || static_cast<std::size_t>(number) >= outline->instances.size()) return json;
  const auto instance = static_cast<std::size_t>(number);
  json["object"] = outline->instances[instance];
  json["position"] = values_at(*positions, pixel);
  if (const std::optional<Box> box = outline->object_around(instance)) {
    const Vec3 center = box->center();
    json["center"] = {center.x(), center.y(), center.z()};
    json["radius"] = 0.5f * box->diagonal().norm();
  }
  return json;
}

}  // namespace gatelight::apps
