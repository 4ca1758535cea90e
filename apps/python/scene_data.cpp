#include "apps/python/scene_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/python/keywords.h"
#include "apps/python/waiting.h"
#include "apps/settings/complete_settings.h"
#include "base/clock.h"
#include "base/errors.h"
#include "scene/finish.h"
#include "scene/mesh_arrays.h"

namespace gatelight::python {
namespace {

namespace py = pybind11;

template <class Rows>
void select(Rows& rows, const std::vector<std::uint32_t>& selection) {
  if (rows.empty() || selection.empty()) return;
  Rows chosen;
  chosen.reserve(selection.size());
  for (const std::uint32_t i : selection) chosen.push_back(rows[i]);
  rows = std::move(chosen);
}

void add_warning(scene::Scene& scene, std::string text) {
  if (std::find(scene.warnings.begin(), scene.warnings.end(), text) == scene.warnings.end())
    scene.warnings.push_back(std::move(text));
}

/// What the loader does with the arrays of a primitive.
void complete(scene::Scene& scene, scene::Mesh& mesh) {
  const scene::Warn warn = [&](std::string_view text) { add_warning(scene, std::string(text)); };
  const std::vector<std::uint32_t> selection = scene::compact_vertices(mesh.triangles, mesh.positions.size());
  select(mesh.positions, selection);
  select(mesh.normals, selection);
  select(mesh.uv0, selection);
  select(mesh.colors, selection);
  scene::MeshNeeds needs = scene::mesh_needs(scene.materials[static_cast<std::size_t>(mesh.material)]);
  scene::choose_directions(needs, false, !mesh.uv0.empty(), warn);
  if (!needs.uv[0]) mesh.uv0.clear();
  scene::complete_mesh(mesh, needs, warn);
}

void complete_own_meshes(scene::Scene& scene, const std::vector<char>& own) {
  int plain = -1;  // the material of meshes without one
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    scene::Mesh& mesh = scene.meshes[i];
    if (mesh.material < 0) {
      if (plain < 0) {
        plain = static_cast<int>(scene.materials.size());
        scene.materials.emplace_back();
      }
      mesh.material = plain;
    }
    if (i < own.size() && own[i] != 0) complete(scene, mesh);
  }
}

}  // namespace

ScenePointer load_scene(const std::string& path, const py::dict& keywords) {
  apps::RenderSettings settings = read_keywords(keywords);
  require_given(
      settings,
      [](const apps::Option& option) {
        return option.marks.stage == apps::OptionStage::load || option.name == "threads" ||
               option.name == "fps" || option.name == "shutter";
      },
      "does not apply to loading", "it in gatelight.render");
  settings.scene = path;
  apps::complete_settings(settings);
  apps::check_inputs(settings);
  auto data = std::make_shared<SceneData>();
  data->loading = settings;
  scene::LoadOptions options = settings.load;
  if (options.time) *options.time += settings.frames.shutter.middle() / settings.frames.fps;
  const Clock::time_point start = Clock::now();
  Waiting waiting;
  waiting.run([&] {
    data->file = std::make_unique<scene::SceneFile>(path, options);
    data->source = data->file->read();
  });
  data->load_seconds = seconds_since(start);
  data->own_meshes.assign(data->source.meshes.size(), 0);
  return data;
}

scene::Scene finish_scene(SceneData& data, SceneContent copy) {
  scene::Scene scene = std::move(copy.source);
  complete_own_meshes(scene, copy.own_meshes);
  if (data.file) {
    const std::lock_guard lock(data.file_mutex);
    data.file->finish(scene);
    if (copy.shown) data.file->show(scene, *copy.shown);
    return scene;
  }
  if (scene.instances.empty() && !scene.meshes.empty())
    add_warning(scene, "the scene has meshes, but no instance that shows them (Scene.add_instance)");
  scene::finish_geometry(scene, true);
  const std::string wrong = scene::wrong_bounds(scene, scene.bounds);
  if (!wrong.empty()) throw InputError(fmt::format("the world: {}", wrong));
  return scene;
}

std::shared_ptr<const scene::Scene> finished_scene(const ScenePointer& data) {
  if (data->finished) return data->finished;
  SceneContent copy = *data;
  const std::uint64_t revision = data->revision;
  std::shared_ptr<const scene::Scene> scene;
  Waiting waiting;
  waiting.run([&] { scene = std::make_shared<const scene::Scene>(finish_scene(*data, std::move(copy))); });
  if (revision == data->revision) data->finished = scene;
  return scene;
}

}  // namespace gatelight::python
