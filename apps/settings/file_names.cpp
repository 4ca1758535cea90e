#include "apps/settings/file_names.h"

#include <fmt/format.h>

#include <system_error>

#include "apps/settings/picture_output.h"
#include "apps/terminal/errors.h"
#include "base/file/atomic_file.h"

namespace gatelight::apps {
namespace {

namespace fs = std::filesystem;

bool is_file(const std::string& name) {
  return !name.empty() && !stdout_format(name);
}

/// A path that cannot be resolved stays as it is named; opening it will fail later.
fs::path place_of(const std::string& name) {
  std::error_code error;
  const fs::path file = replaced_file(fs::absolute(name, error));
  const fs::path folder = fs::weakly_canonical(file.parent_path(), error);
  return error ? file.lexically_normal() : folder / file.filename();
}

}  // namespace

void FileNames::read(std::string_view option, const std::string& name) {
  if (is_file(name)) flags_.emplace(place_of(name), option);
}

void FileNames::write(std::string_view option, const std::string& name, std::string_view may_replace) {
  if (!is_file(name)) return;
  const auto [entry, is_new] = flags_.emplace(place_of(name), option);
  if (is_new || entry->second == may_replace) return;
  if (entry->second == option)
    throw BadOption({std::string(option), name, "is named twice", "different files"});
  throw BadOption(
      {std::string(option), name, fmt::format("is the file of `{}` too", entry->second), "another"});
}

FileNames read_files(const RenderSettings& settings) {
  FileNames names;
  names.read("SCENE", settings.scene);
  for (const scene::LightProfile& profile : settings.load.profiles) names.read("ies", profile.file);
  names.read("environment", settings.render.environment.file);
  names.read("background", settings.render.background.file);
  names.read("view-file", settings.view_file);
  names.read("config", settings.config);
  names.read("cache-in", settings.render.cache.cache_in);
  return names;
}

void check_file_names(std::span<const RenderSettings> pictures) {
  FileNames names = read_files(pictures.front());
  for (const RenderSettings& picture : pictures) {
    for (const std::string& output : picture.outputs) names.write("output", output);
    names.write("stats", picture.stats);
  }
  names.write("cache-out", pictures.front().render.cache.cache_out, "cache-in");
  names.write("checkpoint", pictures.front().render.checkpoint.file);
}

}  // namespace gatelight::apps
