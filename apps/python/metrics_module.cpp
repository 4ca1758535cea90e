#include <fmt/format.h>
#include <pybind11/stl.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "apps/python/keywords.h"
#include "apps/python/module.h"
#include "apps/python/picture_data.h"
#include "apps/python/waiting.h"
#include "apps/settings/parsing.h"
#include "apps/terminal/version.h"
#include "base/errors.h"
#include "base/platform/threads.h"
#include "renderer/driver/denoise_picture.h"
#include "renderer/metrics/compare.h"
#include "renderer/metrics/flip.h"
#include "renderer/metrics/ssim.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

constexpr const char* kMetrics[] = {"mse",  "rel_mse", "psnr", "mean",    "max",
                                    "bias", "ssim",    "flip", "hdr_flip"};

std::vector<std::string> metrics_of(py::handle given) {
  std::vector<std::string> metrics;
  if (py::isinstance<py::str>(given)) {
    metrics = apps::split_list("metric", given.cast<std::string>());
  } else {
    for (const py::handle word : given) metrics.push_back(text_of("metric", word));
  }
  for (const std::string& metric : metrics) {
    if (std::find(std::begin(kMetrics), std::end(kMetrics), metric) != std::end(kMetrics)) continue;
    std::vector<std::string_view> names(std::begin(kMetrics), std::end(kMetrics));
    apps::refuse_choice("metric", metric, apps::join_names(names));
  }
  return metrics;
}

double measure(const std::string& metric, const renderer::NamedPicture& reference,
               const renderer::NamedPicture& test, const renderer::FlipOptions& shown) {
  if (metric == "ssim")
    return renderer::ssim(reference, test, {.exposure = shown.exposure, .tonemap = shown.tonemap});
  if (metric == "flip") return renderer::ldr_flip(reference, test, shown).summary.mean;
  if (metric == "hdr_flip") return renderer::hdr_flip(reference, test, shown).summary.mean;
  const renderer::ErrorMetrics errors = renderer::compare_pictures(reference, test);
  if (metric == "mse") return errors.mse;
  if (metric == "rel_mse") return errors.rel_mse;
  if (metric == "psnr") return errors.psnr;
  if (metric == "mean") return errors.mean_error;
  if (metric == "max") return errors.max_error;
  return errors.mean_difference;
}

py::dict compare(const py::object& reference, const py::object& test, const py::object& metric,
                 const py::object& exposure, const py::object& tonemap) {
  const std::vector<std::string> metrics = metrics_of(metric);
  py::dict keywords;
  keywords["exposure"] = exposure;
  keywords["tonemap"] = tonemap;
  const apps::RenderSettings settings = read_keywords(keywords);
  renderer::FlipOptions shown;
  shown.exposure = settings.exposure.value_or(0.0f);
  shown.tonemap = settings.image.display.tonemap;
  const PicturePointer a = picture_of("reference", reference), b = picture_of("test", test);
  std::vector<double> values;
  Waiting waiting;
  waiting.run([&] {
    for (const std::string& name : metrics)
      values.push_back(measure(name, {a->picture, "reference"}, {b->picture, "test"}, shown));
  });
  py::dict result;
  for (std::size_t i = 0; i < metrics.size(); ++i) result[py::str(metrics[i])] = values[i];
  return result;
}

/// The picture with the layers that are given as arrays.
PicturePointer noisy(const py::object& color, const py::object& albedo, const py::object& normal) {
  auto data = std::make_shared<PictureData>();
  if (py::isinstance<PictureData>(color) || py::isinstance<py::str>(color))
    *data = *picture_of("color", color);
  if (data->picture.layers.empty()) *data = *picture_of("color", color);
  int &width = data->picture.width, &height = data->picture.height;
  const auto add = [&](const char* name, const py::object& values, std::vector<std::string> channels) {
    if (values.is_none()) return;
    renderer::Layer layer = layer_of(name, values, name, width, height);
    if (layer.channels.size() != 3)
      throw BadOption({name, "", "it has no colours", "an array of shape (h, w, 3)"});
    layer.channels = std::move(channels);
    std::erase_if(data->picture.layers, [&](const renderer::Layer& other) { return other.name == name; });
    data->picture.layers.push_back(std::move(layer));
  };
  add("albedo", albedo, {"R", "G", "B"});
  add("normal", normal, {"X", "Y", "Z"});
  return data;
}

PicturePointer denoise(const py::object& color, const py::object& albedo, const py::object& normal,
                       const py::kwargs& keywords) {
  const apps::RenderSettings settings = read_keywords(keywords);
  require_given(
      settings, [](const apps::Option& option) { return option.marks.of_denoise; },
      "is not an option of a denoiser");
  const PicturePointer data = noisy(color, albedo, normal);
  const renderer::RenderOptions& options = settings.render;
  Waiting waiting;
  waiting.run([&] {
    const std::string place = apps::oidn_place(options.denoise.library);
    const renderer::OidnLibrary& oidn = renderer::load_oidn(place);
    const int threads = options.threads > 0 ? options.threads : available_threads();
    require_threads(threads);
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism,
                                      static_cast<std::size_t>(threads));
    tbb::task_arena arena(threads);
    renderer::Denoiser denoiser(oidn, threads, options.memory_limit_bytes);
    const std::vector<renderer::LayersToDenoise> layers = renderer::layers_to_denoise(data->picture);
    std::optional<renderer::Picture> finished = arena.execute([&] {
      return renderer::denoise_picture(
          std::move(data->picture), layers, denoiser,
          {options.denoise.prefilter, options.filter, options.filter_width, options.background},
          [&](double) { return !waiting.stopped(); });
    });
    if (finished) data->picture = std::move(*finished);
  });
  return data;
}

}  // namespace

void add_metrics(py::module_& module) {
  module.def("compare", compare, py::arg("reference"), py::arg("test"), py::arg("metric"),
             py::arg("exposure"), py::arg("tonemap"));
  module.def("denoise", denoise, py::arg("color"), py::arg("albedo"), py::arg("normal"));
}

}  // namespace gatelight::python
