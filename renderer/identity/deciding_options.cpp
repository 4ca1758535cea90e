#include "renderer/identity/deciding_options.h"

#include <fmt/format.h>

#include "renderer/settings/option_table.h"

namespace gatelight::renderer {
namespace {

/// New options follow these: the names of a sweep's cells depend on the order of the texts.
constexpr const char* kOrder =
    "integrator size region seed max-depth min-depth sampler filter filter-width mis direct "
    "light-selection clamp ao-distance aov train-steps batch train-path-length samples-per-point "
    "training-points candidates self-training self-training-vertices self-training-full "
    "self-training-attenuation loss learning-rate beta1 beta2 epsilon l2-network learning-decay update "
    "feature-step feature-precision average average-decay average-ramp start-at-mean max-target "
    "count-triangles training-seed encoding hash-levels hash-features hash-base hash-growth "
    "hash-log2-size hash-memory hash-bytes hash-bounds features stack resolution gate-node-spacing "
    "resolution-scale fixed-resolution max-resolution storage cluster gate-memory gate-memory-is-cap "
    "gate-bytes node-spacing cache-memory hidden layers outputs leaky-slope bias direction-input "
    "normal-input albedo-input scout cache-holds query-at view cache-roughness spread-threshold "
    "query-precision device cache-in";

template <class Dense>
std::string numbers(const Eigen::DenseBase<Dense>& values) {
  std::string text;
  for (Eigen::Index column = 0; column < values.cols(); ++column) {
    for (Eigen::Index row = 0; row < values.rows(); ++row)
      text += fmt::format("{}{}", text.empty() ? "" : ",", float{values(row, column)});
  }
  return text;
}

std::string text_of(const View& view) {
  const scene::Camera& camera = view;
  const auto& [name, node, transform, orthographic, vertical_fov, aspect, half_height, half_width] = camera;
  std::string text = fmt::format("{} {}", numbers(transform.matrix()),
                                 orthographic ? fmt::format("orthographic {},{}", half_height, half_width)
                                              : fmt::format("fov {} aspect {}", vertical_fov, aspect));
  if (view.panorama) text += " panorama";
  if (view.lens_radius > 0.0f)
    text += fmt::format(" lens {},{},{}", view.lens_radius, view.focus_distance, view.blades);
  return text;
}

std::string deciding_text(const Option& option) {
  if (option.deciding) return option.deciding();
  const bool none = std::holds_alternative<std::monostate>(option.value());
  return none ? option.if_none : option.text();
}

}  // namespace

NamedTexts deciding_options(const RenderOptions& options, const View& view, const NamedTexts& machine) {
  RenderOptions copy = options;
  std::vector<Option> table = option_table(copy);
  put_first(table, kOrder);
  NamedTexts texts;
  for (const Option& option : table) {
    if (!option.decides || (option.of_cache && !uses_cache(options.integrator)) ||
        (option.encoding && *option.encoding != options.cache.encoding))
      continue;
    texts.push_back({option.name, deciding_text(option)});
    if (option.name == "region") texts.push_back({"camera", text_of(view)});
  }
  texts.insert(texts.end(), machine.begin(), machine.end());
  return texts;
}

}  // namespace gatelight::renderer
