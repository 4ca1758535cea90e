#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "apps/python/arrays.h"
#include "apps/python/keywords.h"
#include "apps/python/module.h"
#include "apps/python/picture_data.h"
#include "base/nearest_word.h"
#include "renderer/image/auto_exposure.h"
#include "renderer/image/image_read.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

/// The name of the first layer, which has none in files.
constexpr const char* kBeauty = "beauty";

std::string name_of(const renderer::Layer& layer) {
  return layer.name.empty() ? kBeauty : layer.name;
}

std::vector<py::ssize_t> shape_of(const PictureData& data, const renderer::Layer& layer) {
  std::vector<py::ssize_t> shape = {data.picture.height, data.picture.width};
  if (layer.channels.size() > 1) shape.push_back(static_cast<py::ssize_t>(layer.channels.size()));
  return shape;
}

py::array array_of(const PicturePointer& data, const renderer::Layer& layer) {
  return py::array(py::dtype::of<float>(), shape_of(*data, layer), layer.values.data(), py::cast(data));
}

py::buffer_info buffer_of(PictureData& data) {
  renderer::Layer& layer = data.picture.layers.front();
  std::vector<py::ssize_t> shape = shape_of(data, layer);
  std::vector<py::ssize_t> strides(shape.size(), sizeof(float));
  for (std::size_t i = shape.size() - 1; i > 0; --i) strides[i - 1] = strides[i] * shape[i];
  return {layer.values.data(),
          sizeof(float),
          py::format_descriptor<float>::format(),
          static_cast<py::ssize_t>(shape.size()),
          shape,
          strides};
}

const renderer::Layer& find(const PictureData& data, const std::string& name) {
  std::vector<std::string> names;
  for (const renderer::Layer& layer : data.picture.layers) {
    names.push_back(name_of(layer));
    if (names.back() == name) return layer;
  }
  std::string text;
  for (const std::string& known : names) text += (text.empty() ? "" : ", ") + known;
  throw py::key_error(fmt::format("'{}' is not a layer of the picture, expected one of: {}{}", name, text,
                                  did_you_mean(name, names)));
}

/// The picture's way to be shown, with these keywords instead.
renderer::ImageWriteOptions image_options(const PictureData& data, const py::kwargs& keywords) {
  apps::RenderSettings shown;
  shown.image = data.image;
  shown.exposure = data.image.display.exposure;
  apps::RenderSettings settings = read_keywords(keywords, std::move(shown));
  require_given(
      settings, [](const apps::Option& option) { return option.marks.stage == apps::OptionStage::output; },
      "is not an option of a file");
  settings.image.display.exposure =
      settings.exposure ? *settings.exposure : renderer::auto_exposure(data.picture);
  return settings.image;
}

py::array display(const PictureData& data, const py::kwargs& keywords) {
  const renderer::ImageWriteOptions image = image_options(data, keywords);
  std::vector<std::uint8_t> bytes;
  {
    const py::gil_scoped_release release;
    bytes = renderer::display_bytes(data.picture, image.display);
  }
  py::array_t<std::uint8_t> shown({data.picture.height, data.picture.width, 3});
  std::copy(bytes.begin(), bytes.end(), shown.mutable_data());
  return shown;
}

void save(const PictureData& data, const py::object& path, const py::kwargs& keywords) {
  const renderer::ImageWriteOptions image = image_options(data, keywords);
  const std::string file = text_of("path", path);
  const py::gil_scoped_release release;
  renderer::write_image(data.picture, file, image);
}

py::bytes png(const PictureData& data) {
  std::vector<std::uint8_t> bytes;
  {
    const py::gil_scoped_release release;
    bytes = renderer::encode_image(data.picture, renderer::ImageFormat::png, data.image);
  }
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

renderer::Layer layer_of(const char* name, py::handle values, const char* layer, int& width, int& height) {
  const py::array given = py::array::ensure(values);
  const bool fits =
      given && (given.ndim() == 2 || (given.ndim() == 3 && given.shape(2) == 3)) && given.size() > 0;
  if (!given) PyErr_Clear();
  if (!fits) throw BadOption({name, "", "is not a picture", "one, or an array of shape (h, w, 3) or (h, w)"});
  if (height == 0) {
    height = static_cast<int>(given.shape(0));
    width = static_cast<int>(given.shape(1));
  }
  if (given.shape(0) != height || given.shape(1) != width)
    throw BadOption({name, python::shape_of(given), "is the array's shape",
                     fmt::format("({}, {}) pixels", height, width)});
  const Array<float> floats(given);
  const bool grey = given.ndim() == 2;
  return {.name = layer,
          .channels = grey ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"},
          .values = {floats.data(), floats.data() + floats.size()}};
}

PicturePointer picture_of(const char* name, py::handle value) {
  if (py::isinstance<PictureData>(value)) return value.cast<PicturePointer>();
  auto data = std::make_shared<PictureData>();
  if (py::isinstance<py::str>(value) || py::hasattr(value, "__fspath__")) {
    const std::string file = text_of(name, value);
    const py::gil_scoped_release release;
    data->picture = renderer::read_image(file);
    return data;
  }
  data->picture.layers.push_back(layer_of(name, value, "", data->picture.width, data->picture.height));
  return data;
}

void add_picture(py::module_& module) {
  py::class_<PictureData, PicturePointer> picture(
      module, "Picture", py::buffer_protocol(),
      "A rendered picture. numpy.asarray(picture) is its beauty layer, (h, w, 3) float32 in linear Rec. 709 "
      "radiance, rows "
      "from the top, without a copy.");
  picture.def_buffer(buffer_of);
  picture.def("__getitem__",
              [](const PicturePointer& p, const std::string& name) { return array_of(p, find(*p, name)); });
  picture.def("__contains__", [](const PicturePointer& p, const std::string& name) {
    const auto& layers = p->picture.layers;
    return std::any_of(layers.begin(), layers.end(),
                       [&](const auto& layer) { return name_of(layer) == name; });
  });
  picture.def_property_readonly(
      "layers",
      [](const PicturePointer& p) {
        py::dict layers;
        for (const renderer::Layer& layer : p->picture.layers)
          layers[py::str(name_of(layer))] = array_of(p, layer);
        return layers;
      },
      "Every layer by name, as (h, w) or (h, w, channels) float32, without a copy; 'beauty' is the picture");
  picture.def_property_readonly("width", [](const PicturePointer& p) { return p->picture.width; });
  picture.def_property_readonly("height", [](const PicturePointer& p) { return p->picture.height; });
  picture.def_property_readonly(
      "metadata", [](const PicturePointer& p) { return p->picture.metadata; },
      "How the picture was made, as in an EXR");
  picture.def_property_readonly(
      "statistics",
      [](const PicturePointer& p) { return py::module_::import("json").attr("loads")(p->statistics); },
      "What --stats writes, as a dict");
  picture.def(
      "display", [](const PicturePointer& p, const py::kwargs& keywords) { return display(*p, keywords); },
      "(h, w, 3) uint8 as a PNG shows it. Keywords: exposure (stops or 'auto'), tonemap, white_balance, "
      "ocio.");
  picture.def(
      "save",
      [](const PicturePointer& p, const py::object& path, const py::kwargs& keywords) {
        save(*p, path, keywords);
      },
      py::arg("path"),
      "Writes .exr (all layers), .png, .jpg, .tif or .hdr. Keywords: those of display(), bits (8 or 16), exr "
      "('half' or "
      "'float').");
  picture.def("_repr_png_", [](const PicturePointer& p) { return png(*p); });
  picture.def("__repr__", [](const PicturePointer& p) {
    return fmt::format("<gatelight.Picture {}x{}, {} layers>", p->picture.width, p->picture.height,
                       p->picture.layers.size());
  });
  module.def(
      "read", [](const py::object& path) { return picture_of("path", py::str(text_of("path", path))); },
      py::arg("path"), "Reads a picture: .exr with all layers, .hdr, .png.");
}

}  // namespace gatelight::python
