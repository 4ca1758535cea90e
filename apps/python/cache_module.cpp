#include <fmt/format.h>
#include <pybind11/stl.h>

#include "apps/python/cache_field.h"
#include "apps/python/keywords.h"
#include "apps/python/module.h"
#include "apps/python/scene_parts.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

scene::Scene triangles_of(py::handle given) {
  if (py::isinstance<SceneData>(given)) return given.cast<ScenePointer>()->source;
  if (!py::isinstance<MeshPart>(given))
    throw BadOption({"scene", "", "is not a scene", "a gatelight.Scene or a gatelight.Mesh"});
  const auto part = given.cast<MeshPart>();
  scene::Scene scene;
  scene.meshes.push_back(*part);
  scene.instances.emplace_back().mesh = 0;
  return scene;
}

FieldPoints points_of(const CacheField& field, const py::object& points) {
  return field.points(points.attr("instances"), points.attr("triangles"), points.attr("barycentrics"));
}

py::array train(CacheField& field, const py::object& points, const py::object& targets, int steps,
                std::uint64_t seed, const py::object& stop) {
  const FieldPoints of_scene = points_of(field, points);
  py::object given = targets;
  if (field.outputs() == 1 && py::array::ensure(given).ndim() == 1)
    given = py::array::ensure(given).attr("reshape")(-1, 1);
  const Array<float> values = rows<float>("targets", given, field.outputs());
  if (static_cast<std::size_t>(values.shape(0)) != of_scene.surfaces.size() || values.shape(0) == 0)
    throw BadOption({"targets", shape_of(values), "is the array's shape",
                     fmt::format("({}, {})", of_scene.surfaces.size(), field.outputs())});
  std::vector<double> losses;
  Waiting waiting(py::none(), stop);
  waiting.run([&] {
    losses =
        field.train(of_scene, {values.data(), static_cast<std::size_t>(values.size())}, steps, seed, waiting);
  });
  return py::array_t<double>(static_cast<py::ssize_t>(losses.size()), losses.data());
}

py::array query(const CacheField& field, const py::object& points) {
  const FieldPoints of_scene = points_of(field, points);
  py::array_t<float> out(
      {static_cast<py::ssize_t>(of_scene.surfaces.size()), static_cast<py::ssize_t>(field.outputs())});
  const std::span<float> values(out.mutable_data(), static_cast<std::size_t>(out.size()));
  Waiting waiting;
  waiting.run([&] { field.query(of_scene, values); });
  return out;
}

}  // namespace

void add_cache(py::module_& module) {
  py::class_<CacheField> cache(module, "Cache",
                               "A neural field on the triangles of a scene or a mesh: features on the "
                               "surface and a small network. It learns any "
                               "function of the point, without light transport.");
  cache.def(py::init([](const py::object& scene, const std::string& encoding, std::uint32_t outputs,
                        py::kwargs options) {
              options["encoding"] = encoding;
              return std::make_unique<CacheField>(triangles_of(scene), outputs, options);
            }),
            py::arg("scene"), py::arg("encoding") = "gate", py::arg("outputs") = 3,
            "encoding: gate or hashgrid. outputs: numbers in an answer, 1 to 16. Options: those of the "
            "groups 'Cache' of gatelight.options(), such as node_spacing (metres), cache_memory (MiB), "
            "hidden, layers, learning_rate, batch, normal_input.");
  cache.def("train", train, py::arg("points"), py::arg("targets"), py::arg("steps") = 256, py::kw_only(),
            py::arg("seed") = 0, py::arg("stop") = py::none(),
            "Trains with batches drawn from the points (Points) and their targets (n, outputs). Returns the "
            "loss before "
            "each step, (steps,) float64.");
  cache.def("query", query, py::arg("points"), "The answers at points (Points): (n, outputs) float32.");
  cache.def(
      "save", [](const CacheField& field, const py::object& path) { field.save(text_of("path", path)); },
      py::arg("path"), "Writes the state to a .safetensors file.");
  cache.def_static(
      "load",
      [](const py::object& path, const py::object& scene) {
        const std::string file = text_of("path", path);
        const auto [outputs, options] = field_options(file);
        auto field = std::make_unique<CacheField>(triangles_of(scene), outputs, options);
        field->load(file);
        return field;
      },
      py::arg("path"), py::arg("scene"), "Reads a file of save(), for the same triangles.");
  cache.def_property_readonly("outputs", &CacheField::outputs);
  cache.def_property_readonly("bytes", &CacheField::parameter_bytes, "Memory of features and network");
  cache.def_property_readonly("steps", &CacheField::steps, "Number of training steps so far");
}

}  // namespace gatelight::python
