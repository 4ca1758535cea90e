#include "apps/sweep/report.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "apps/settings/render_settings.h"
#include "apps/sweep/page.h"
#include "apps/sweep/picture_uri.h"
#include "renderer/image/image_read.h"
#include "renderer/settings/enum_names.h"

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

/// A picture that the page shows.
struct Wanted {
  std::string file;      ///< as results.json names it
  ordered_json display;  ///< for a reference {"exposure", "tonemap"} of its cells; null for a PNG
  PictureKind kind = PictureKind::light;

  bool operator==(const Wanted&) const = default;
};

void add(std::vector<Wanted>& pictures, Wanted wanted) {
  if (wanted.file.empty()) return;
  if (std::find(pictures.begin(), pictures.end(), wanted) == pictures.end())
    pictures.push_back(std::move(wanted));
}

/// Older results name references by their kind only.
bool is_compared_with(const ordered_json& cell, const ordered_json& reference) {
  const std::string id = word(reference, "id");
  const std::string cells = word(cell, "reference_id");
  if (!id.empty() && !cells.empty()) return id == cells;
  return word(cell, "reference") == word(reference, "kind");
}

/// Adds a reference once for each exposure and curve of its cells.
void add_reference(std::vector<Wanted>& pictures, const ordered_json& cells, const std::string& scene,
                   const ordered_json& reference) {
  for (const ordered_json& cell : cells) {
    if (word(cell, "picture").empty() || word(cell, "scene") != scene || !is_compared_with(cell, reference))
      continue;
    const ordered_json& options = at(cell, "options");
    add(pictures, {word(reference, "file"),
                   {{"exposure", at(options, "exposure")}, {"tonemap", at(options, "tonemap")}}});
  }
}

std::vector<Wanted> list_pictures(const ordered_json& results) {
  std::vector<Wanted> pictures;
  for (const ordered_json& cell : at(results, "cells")) {
    add(pictures, {word(cell, "picture"), nullptr});
    add(pictures, {word(cell, "error_map"), nullptr, PictureKind::map});
  }
  for (const ordered_json& scene : at(results, "scenes")) {
    for (const ordered_json& reference : at(scene, "references")) {
      add_reference(pictures, at(results, "cells"), word(scene, "name"), reference);
    }
  }
  return pictures;
}

renderer::ImageWriteOptions write_options(const ordered_json& display) {
  renderer::ImageWriteOptions options;
  if (at(display, "exposure").is_number()) options.display.exposure = at(display, "exposure").get<float>();
  for (const renderer::Choice<renderer::Tonemap>& choice : renderer::kEnumNames<renderer::Tonemap>) {
    if (choice.name == word(display, "tonemap")) options.display.tonemap = choice.value;
  }
  return options;
}

/// Up to this many pictures and maps are shown at full width, about 15 MB where they are noisy. More pictures
/// share the same number of pixels.
constexpr double kFullWidthCount = 60.0;
constexpr int kLeastWidth = 480;

/// Maps are shown side by side, and need less detail.
int max_width(PictureKind kind, std::size_t count) {
  const double scale = std::sqrt(kFullWidthCount / static_cast<double>(count));
  const int width = std::clamp(static_cast<int>(kMaxPictureWidth * scale), kLeastWidth, kMaxPictureWidth);
  return kind == PictureKind::map ? 3 * width / 4 : width;
}

/// Returns nothing where there is no such picture.
std::optional<PagePicture> read_picture(const Wanted& wanted, const std::filesystem::path& folder,
                                        std::size_t count) {
  EmbeddedPicture picture;
  try {
    // operator/ keeps an absolute path.
    picture = embed_picture(renderer::read_image(folder / wanted.file), write_options(wanted.display),
                            wanted.kind, max_width(wanted.kind, count));
  } catch (const InputError&) {
    return std::nullopt;
  } catch (const UnknownFormat&) {
    return std::nullopt;
  }
  PagePicture embedded{.entry = {{"file", wanted.file}}, .uri = std::move(picture.uri)};
  if (wanted.display.is_object()) embedded.entry.update(wanted.display);
  embedded.entry["size"] = picture.size;
  embedded.entry["width"] = picture.width;
  return embedded;
}

}  // namespace

std::string make_report(const ordered_json& results, const std::string& folder) {
  const std::vector<Wanted> wanted = list_pictures(results);
  std::vector<std::optional<PagePicture>> read(wanted.size());
  tbb::parallel_for(std::size_t{0}, wanted.size(),
                    [&](std::size_t i) { read[i] = read_picture(wanted[i], folder, wanted.size()); });
  std::vector<PagePicture> pictures;
  for (std::optional<PagePicture>& picture : read) {
    if (picture) pictures.push_back(std::move(*picture));
  }
  return make_page(results, pictures);
}

}  // namespace gatelight::apps
