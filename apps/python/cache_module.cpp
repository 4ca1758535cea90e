// A neural field on the triangles of a scene, without light transport.

#include <fmt/format.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/python/arrays.h"
#include "apps/python/keywords.h"
#include "apps/python/module.h"
#include "apps/python/scene_parts.h"
#include "apps/python/waiting.h"
#include "apps/settings/render_settings.h"
#include "base/file/digest.h"
#include "base/random.h"
#include "neural/model/model_file.h"
#include "neural/trainer.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/scene_layout.h"
#include "scene/scene.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

/// Points as the arrays of gatelight.Points.
struct FieldPoints {
  std::vector<std::uint32_t> surfaces, triangles;
  std::vector<neural::Float2> barycentrics;
  std::vector<neural::Float3> positions, normals;

  neural::QueryBatch batch() const;
  FieldPoints chosen(const std::vector<std::size_t>& indices) const;
};

class CacheField {
 public:
  /// Options of the cache among `keywords`. `scene` holds instances with their own transforms.
  CacheField(scene::Scene scene, std::uint32_t outputs, const py::dict& keywords);

  /// Throws BadOption for indices and barycentrics that are not of the scene.
  FieldPoints points(py::handle instances, py::handle triangles, py::handle barycentrics) const;
  /// Steps on batches that are drawn from the points. Returns the loss before each step.
  std::vector<double> train(const FieldPoints& points, std::span<const float> targets, int steps,
                            std::uint64_t seed, const Waiting& waiting);
  void query(const FieldPoints& points, std::span<float> out) const;
  void save(const std::string& path) const;
  void load(const std::string& path);

  std::uint32_t outputs() const { return trainer_->model().config.mlp.outputs; }
  std::uint64_t parameter_bytes() const { return trainer_->backend().parameter_bytes(); }
  std::uint64_t steps() const { return steps_; }

 private:
  scene::Scene scene_;
  apps::RenderSettings settings_;
  std::string fingerprint_;
  std::unique_ptr<neural::Trainer> trainer_;
  std::uint64_t steps_ = 0;
};

/// Memory of the features where no option sets it.
constexpr std::uint64_t kChosenBytes = std::uint64_t{4} << 20;
constexpr const char* kKind = "gatelight field 1";

/// Throws BadOption for options that a field does not use.
apps::RenderSettings read_cache_keywords(const py::dict& keywords) {
  apps::RenderSettings settings = read_keywords(keywords);
  require_given(
      settings, [](const apps::Option& option) { return option.marks.of_field; }, "a field does not use it",
      "one of features, network or training");
  if (!settings.given.contains("loss")) settings.render.cache.training.loss = neural::Loss::l2;
  settings.render.cache.training.seed += settings.render.seed;
  return settings;
}

std::string digest_of_triangles(const scene::Scene& scene) {
  DigestRecord record;
  const auto add = [&](const auto& values) {
    record.add(gatelight::digest_of(std::as_bytes(std::span(values.data(), values.size()))));
  };
  for (const scene::Instance& instance : scene.instances) {
    const Eigen::Matrix<float, 3, 4> matrix = instance.transform.matrix().topRows<3>();
    for (int i = 0; i < 12; ++i) record.add(matrix.data()[i]);
    add(scene.mesh_of(instance).positions);
    add(scene.mesh_of(instance).triangles);
  }
  return hexadecimal(record.digest());
}

std::shared_ptr<const neural::Model> model_of(const scene::Scene& scene, std::uint32_t outputs,
                                              const renderer::CacheOptions& options) {
  Box bounds;
  for (const scene::Instance& instance : scene.instances)
    for (const Vec3& p : scene.mesh_of(instance).positions) bounds.extend(instance.transform * p);
  neural::ModelConfig config = renderer::model_config(options, bounds);
  config.mlp.outputs = outputs;
  const bool open = !options.node_spacing && config.gate.rule == neural::ResolutionRule::uniform;
  if (open && options.memory_bytes == 0) config.gate.memory_budget = kChosenBytes;
  config.auxiliary =
      neural::composite_inputs({.direction = false, .normal = options.normal_input.value_or(false)});
  const renderer::WeldedMeshes meshes(scene);
  const std::vector<neural::Sides> sides(scene.instances.size(), neural::SurfaceInstance().sides);
  return neural::make_model(config, meshes.layout(scene, sides));
}

neural::QueryBatch FieldPoints::batch() const {
  return {.surfaces = surfaces,
          .triangles = triangles,
          .barycentrics = barycentrics,
          .positions = positions,
          .normals = normals,
          .size = surfaces.size()};
}

FieldPoints FieldPoints::chosen(const std::vector<std::size_t>& indices) const {
  FieldPoints points;
  for (const std::size_t i : indices) {
    points.surfaces.push_back(surfaces[i]);
    points.triangles.push_back(triangles[i]);
    points.barycentrics.push_back(barycentrics[i]);
    points.positions.push_back(positions[i]);
    points.normals.push_back(normals[i]);
  }
  return points;
}

CacheField::CacheField(scene::Scene scene, std::uint32_t outputs, const py::dict& keywords)
    : scene_(std::move(scene)), settings_(read_cache_keywords(keywords)) {
  if (scene_.instances.empty()) throw BadOption({"scene", "", "it has no instance", "triangles"});
  if (outputs < 1 || outputs > 16)
    throw BadOption({"outputs", fmt::format("{}", outputs), "", "an integer from 1 to 16"});
  nlohmann::ordered_json options = nlohmann::ordered_json::object();
  for (const auto& [name, value] : keywords)
    if (!value.is_none()) options[std::string(py::str(name))] = text_of(std::string(py::str(name)), value);
  fingerprint_ = nlohmann::ordered_json{{"kind", kKind},
                                        {"outputs", outputs},
                                        {"options", options},
                                        {"triangles", digest_of_triangles(scene_)}}
                     .dump();
  Waiting waiting;
  waiting.run([&] {
    auto model = model_of(scene_, outputs, settings_.render.cache);
    auto backend = renderer::make_cache_backend(model, settings_.render);
    trainer_ = std::make_unique<neural::Trainer>(model, settings_.render.cache.training, std::move(backend));
  });
}

FieldPoints CacheField::points(py::handle instances, py::handle triangles, py::handle barycentrics) const {
  const Array<std::uint32_t> t = rows<std::uint32_t>("triangles", triangles, 0);
  const Array<float> b = rows<float>("barycentrics", barycentrics, 2);
  const py::ssize_t count = t.shape(0);
  Array<std::uint32_t> i;
  if (!instances.is_none()) i = rows<std::uint32_t>("instances", instances, 0);
  if (b.shape(0) != count || (!instances.is_none() && i.shape(0) != count))
    throw BadOption({"barycentrics", shape_of(b), "is the array's shape",
                     fmt::format("({}, 2), one row for each triangle, and one instance for each", count)});
  FieldPoints points;
  for (py::ssize_t p = 0; p < count; ++p) {
    const std::uint32_t number = instances.is_none() ? 0 : i.data()[p], triangle = t.data()[p];
    if (number >= scene_.instances.size())
      throw BadOption({"instances", "", fmt::format("index {} of point {}", number, p),
                       fmt::format("less than {}", scene_.instances.size())});
    const scene::Instance& instance = scene_.instances[number];
    if (triangle >= scene_.mesh_of(instance).triangles.size())
      throw BadOption({"triangles", "", fmt::format("index {} of point {}", triangle, p),
                       fmt::format("less than {}", scene_.mesh_of(instance).triangles.size())});
    const float u = b.data()[2 * p], v = b.data()[2 * p + 1];
    if (!(u >= 0.0f) || !(v >= 0.0f) || !(u + v <= 1.0001f))
      throw BadOption({"barycentrics", "", fmt::format("({}, {}) of point {}", u, v, p),
                       "weights of 0 or more, with a sum of at most 1"});
    const std::array<Vec3, 3> corners = scene::world_triangle(scene_, instance, triangle);
    const Vec3 position = (1.0f - u - v) * corners[0] + u * corners[1] + v * corners[2];
    const Vec3 normal = scene::world_normal(scene_, instance, triangle);
    points.surfaces.push_back(neural::surface_index(number, 0));
    points.triangles.push_back(triangle);
    points.barycentrics.push_back({u, v});
    points.positions.push_back({position.x(), position.y(), position.z()});
    points.normals.push_back({normal.x(), normal.y(), normal.z()});
  }
  return points;
}

std::vector<double> CacheField::train(const FieldPoints& points, std::span<const float> targets, int steps,
                                      std::uint64_t seed, const Waiting& waiting) {
  const std::size_t count = points.surfaces.size(), width = outputs();
  const std::size_t size = std::min<std::size_t>(count, settings_.render.cache.batch);
  std::vector<double> losses;
  for (int step = 0; step < steps && !waiting.stopped(); ++step, ++steps_) {
    if (size == count) {
      losses.push_back(trainer_->train({points.batch(), targets}).loss);
      continue;
    }
    std::vector<std::size_t> indices(size);
    std::vector<float> chosen;
    for (std::size_t k = 0; k < size; ++k) {
      const float random = uniform_float(seed + 0x9e3779b97f4a7c15u * (steps_ + 1), k);
      indices[k] = std::min(count - 1, static_cast<std::size_t>(random * static_cast<float>(count)));
      const auto row = targets.subspan(indices[k] * width, width);
      chosen.insert(chosen.end(), row.begin(), row.end());
    }
    const FieldPoints batch = points.chosen(indices);
    losses.push_back(trainer_->train({batch.batch(), chosen}).loss);
  }
  return losses;
}

void CacheField::query(const FieldPoints& points, std::span<float> out) const {
  trainer_->query(points.batch(), {.range = neural::OutputRange::raw}, out);
}

void CacheField::save(const std::string& path) const {
  trainer_->save(path, fingerprint_);
}

void CacheField::load(const std::string& path) {
  trainer_->load(path, fingerprint_);
  steps_ = trainer_->backend().export_state().steps;
}

/// Outputs and options of a file of CacheField::save(). Throws CacheFileError.
std::pair<std::uint32_t, py::dict> field_options(const std::string& path) {
  const SafetensorsReader file(path);
  const auto found = file.metadata().find("fingerprint");
  const nlohmann::ordered_json json =
      nlohmann::ordered_json::parse(found == file.metadata().end() ? "" : found->second, nullptr, false);
  if (!json.is_object() || json.value("kind", "") != kKind || !json.contains("options"))
    throw CacheFileError(
        fmt::format("'{}' is not a file of gatelight.Cache, expected one that Cache.save() wrote", path));
  py::dict options;
  for (const auto& [name, value] : json["options"].items()) options[py::str(name)] = value.get<std::string>();
  return {json.value("outputs", 3u), options};
}

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
