#include "apps/python/cache_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <utility>

#include "apps/python/keywords.h"
#include "base/file/digest.h"
#include "base/random.h"
#include "neural/model/model_file.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/cache/cache_model.h"
#include "renderer/cache/scene_layout.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

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

}  // namespace

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

}  // namespace gatelight::python
