#include "apps/settings/camera_names.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/settings/file_names.h"
#include "apps/terminal/errors.h"

namespace gatelight::apps {
namespace {

/// A name without characters that end a folder's name.
std::string file_part(std::string name) {
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == '/' || static_cast<unsigned char>(c) < 0x20; }, '_');
  return name;
}

constexpr std::string_view kCamera = "{camera}";

bool names_all(const RenderSettings& settings) {
  return settings.render.camera.name == "all" && !settings.render.camera.look_at;
}

std::string replaced(std::string text, const std::string& name) {
  for (std::size_t at = text.find(kCamera); at != std::string::npos;
       at = text.find(kCamera, at + name.size()))
    text.replace(at, kCamera.size(), name);
  return text;
}

std::string file_name(const scene::Scene& scene, std::size_t index) {
  const auto same = [&](const scene::Camera& other) { return other.name == scene.cameras[index].name; };
  std::string name = scene.cameras[index].name;
  if (name.empty() || std::count_if(scene.cameras.begin(), scene.cameras.end(), same) > 1)
    name += fmt::format("{}{}", name.empty() ? "" : "-", index);
  return name;
}

void name_files(RenderSettings& settings, const std::string& name) {
  const std::string camera = file_part(name);
  for (std::string& output : settings.outputs) output = replaced(output, camera);
  settings.stats = replaced(settings.stats, camera);
}

/// The camera of a single picture, as choose_camera() finds it.
std::string single_name(const RenderSettings& settings, const scene::Scene& scene) {
  if (settings.render.camera.look_at) return "eye";
  if (!settings.render.camera.name.empty()) return settings.render.camera.name;
  return scene.cameras.empty() ? "all-of-it" : file_name(scene, 0);
}

}  // namespace

void check_camera_names(const RenderSettings& settings) {
  if (!names_all(settings)) return;
  const auto require = [&](const char* option, const std::string& file) {
    if (!file.empty() && file.find(kCamera) == std::string::npos)
      throw BadOption({option, file, "is one file for all cameras", "{camera} in its name"});
  };
  for (const std::string& output : settings.outputs) require("output", output);
  if (settings.stats != "-") require("stats", settings.stats);
  const auto refuse = [&](const char* option, const std::string& file) {
    if (!file.empty()) throw BadOption({option, file, "belongs to one picture", "one `camera`"});
  };
  refuse("checkpoint", settings.render.checkpoint.file);
  refuse("cache-out", settings.render.cache.cache_out);
}

std::vector<RenderSettings> pictures_of(const RenderSettings& settings, const scene::Scene& scene) {
  std::vector<RenderSettings> pictures;
  const auto add = [&](const std::string& file) -> RenderSettings& {
    name_files(pictures.emplace_back(settings), file);
    return pictures.back();
  };
  if (!names_all(settings)) {
    add(single_name(settings, scene));
    check_file_names(pictures);
    return pictures;
  }
  if (scene.cameras.empty())
    throw InputError(fmt::format("`camera` all: {} has no camera, expected `eye` and `target`", scene.path));
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    renderer::CameraOptions& camera = add(file_name(scene, i)).render.camera;
    camera.name = fmt::format("{}", i);
    camera.index = i;
  }
  check_file_names(pictures);
  return pictures;
}

}  // namespace gatelight::apps
