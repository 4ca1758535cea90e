#include "apps/sweep/report.h"

#include <tbb/parallel_for.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/render_settings.h"
#include "apps/sweep/page.h"
#include "apps/sweep/picture_uri.h"
#include "renderer/image_read.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

const ordered_json& at(const ordered_json& object, const char* key) {
  static const ordered_json kNull;
  const auto found = object.find(key);
  return found == object.end() ? kNull : *found;
}

std::string word(const ordered_json& object, const char* key) {
  const ordered_json& value = at(object, key);
  return value.is_string() ? value.get<std::string>() : "";
}

/// How the PNG of a cell was made, so that its reference is shown likewise.
renderer::ImageWriteOptions display_of(const ordered_json& cell) {
  renderer::ImageWriteOptions display;
  const ordered_json& options = at(cell, "options");
  if (!options.is_object()) return display;
  if (at(options, "exposure").is_number()) display.exposure = at(options, "exposure").get<float>();
  for (const Choice<renderer::Tonemap>& choice : tonemap_choices()) {
    if (choice.name == word(options, "tonemap")) display.tonemap = choice.value;
  }
  return display;
}

/// By the name that results.json has for the file.
using Shown = std::map<std::string, renderer::ImageWriteOptions>;

void add_references(Shown& shown, const ordered_json& results) {
  for (const ordered_json& scene : at(results, "scenes")) {
    for (const ordered_json& reference : at(scene, "references")) {
      renderer::ImageWriteOptions display;
      for (const ordered_json& cell : at(results, "cells")) {
        if (word(cell, "scene") != word(scene, "name") || word(cell, "reference") != word(reference, "kind"))
          continue;
        display = display_of(cell);
        if (!word(cell, "picture").empty()) break;
      }
      shown[word(reference, "file")] = display;
    }
  }
}

Shown list_pictures(const ordered_json& results) {
  Shown shown;
  for (const ordered_json& cell : at(results, "cells")) {
    // Written for the screen already.
    for (const char* key : {"picture", "error_map"}) shown[word(cell, key)] = {};
  }
  add_references(shown, results);
  shown.erase("");
  return shown;
}

/// References may lie outside of the folder; then their path is the one of the command line.
std::filesystem::path find_file(const std::filesystem::path& folder, const std::filesystem::path& name) {
  std::error_code none;
  return std::filesystem::exists(folder / name, none) ? folder / name : name;
}

/// Empty where there is no such picture.
std::string uri_of(const std::filesystem::path& file, const renderer::ImageWriteOptions& display) {
  try {
    return picture_uri(renderer::read_image(file), display);
  } catch (const renderer::ImageError&) {
    return "";
  } catch (const renderer::UnknownFormat&) {
    return "";
  }
}

}  // namespace

std::string make_report(const ordered_json& results, const std::string& folder) {
  const Shown shown = list_pictures(results);
  const std::vector<Shown::value_type> files(shown.begin(), shown.end());
  std::vector<std::string> uris(files.size());
  tbb::parallel_for(std::size_t{0}, files.size(), [&](std::size_t i) {
    uris[i] = uri_of(find_file(folder, files[i].first), files[i].second);
  });
  ordered_json pictures = ordered_json::object();
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (!uris[i].empty()) pictures[files[i].first] = std::move(uris[i]);
  }
  return make_page(results, pictures);
}

}  // namespace gatelight::apps
