#include "apps/view/view_api.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/job/finished_picture.h"
#include "apps/reports/json.h"
#include "apps/reports/run_report.h"
#include "apps/settings/parsing.h"
#include "apps/terminal/errors.h"
#include "apps/terminal/text.h"
#include "apps/view/shown_layers.h"
#include "base/errors.h"
#include "base/image/jpeg_write.h"
#include "base/image/png_write.h"
#include "gatelight_view_page.inc"
#include "renderer/image/image_write.h"
#include "renderer/settings/aovs.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

constexpr std::chrono::milliseconds kLongestWait{10000};
constexpr std::size_t kLongestName = 40;
constexpr int kJpegQuality = 90;

/// The file of the page, which is a part of the program; a status of 404 for another name.
WebResponse page_file(const std::string& name) {
  if (name.empty()) return {.type = "text/html; charset=utf-8", .body = kViewHtml};
  if (name == "view.css") return {.type = "text/css; charset=utf-8", .body = kViewStyle};
  if (name == "view.js") return {.type = "text/javascript; charset=utf-8", .body = kViewScript};
  return {.status = 404};
}

const char* name_of_stage(Stage stage) {
  constexpr const char* kNames[] = {"none", "draft", "preview", "refined", "final"};
  return kNames[static_cast<int>(stage)];
}

const char* name_of_needs(renderer::AovNeeds needs) {
  constexpr const char* kWords[] = {"nothing",    "light", "frames", "a cache", "a cache of radiance",
                                    "mesh colors"};
  return kWords[static_cast<int>(needs)];
}

WebResponse json_response(const ordered_json& json, int status = 200) {
  return {.status = status, .type = "application/json; charset=utf-8", .body = json_text(json, -1)};
}

WebResponse error_response(int status, const std::string& message) {
  return json_response({{"error", one_line(message)}}, status);
}

std::string parameter(const WebRequest& request, const std::string& name) {
  const auto found = request.query.find(name);
  return found == request.query.end() ? std::string() : found->second;
}

/// A share of the picture's width or height. Throws BadOption.
double place(const WebRequest& request, const std::string& name) {
  return parse_real(name, parameter(request, name), {0.0, 1.0});
}

/// A viewer's name: letters, digits, '-' and '_'. Throws BadOption.
std::string viewer_of(const WebRequest& request) {
  const std::string name = parameter(request, "viewer");
  const auto fits = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  if (name.size() > kLongestName || !std::all_of(name.begin(), name.end(), fits))
    throw BadOption({"viewer", name, "", "at most 40 letters, digits, '-' and '_'"});
  return name.empty() ? "shared" : name;
}

renderer::DisplayOptions display_of(const ShownPicture& shown) {
  renderer::DisplayOptions display = shown.settings.image.display;
  display.exposure = shown.exposure;
  return display;
}

ordered_json describe(const ShownPicture& shown) {
  const renderer::RenderStatistics& s = shown.statistics;
  ordered_json json{{"version", shown.version},
                    {"revision", shown.revision},
                    {"stage", name_of_stage(shown.stage)},
                    {"complete", shown.complete},
                    {"width", shown.picture.width},
                    {"height", shown.picture.height},
                    {"spp", s.spp},
                    {"seconds", shown.seconds},
                    {"exposure", shown.exposure}};
  if (shown.picture.view) {
    json["world_to_camera"] = shown.picture.view->world_to_camera;
    json["world_to_ndc"] = shown.picture.view->world_to_ndc;
  }
  return json;
}

/// The layers that the page offers: those of a scene's pictures, or of the finished picture.
ordered_json describe_layers(const renderer::Picture* finished) {
  ordered_json layers = ordered_json::array();
  if (finished) {
    for (const renderer::Layer& layer : finished->layers)
      layers.push_back({{"name", layer.name}, {"label", layer.name.empty() ? "picture" : layer.name}});
    return layers;
  }
  layers.push_back({{"name", ""}, {"label", "picture"}});
  for (const renderer::AovInfo& row : renderer::kAovs) {
    if (row.label.empty()) continue;
    layers.push_back({{"name", row.name}, {"label", row.label}, {"needs", name_of_needs(row.needs)}});
  }
  return layers;
}

ordered_json values_at(const renderer::Layer& layer, std::size_t pixel) {
  ordered_json values = ordered_json::array();
  const std::size_t channels = layer.channels.size();
  for (std::size_t c = 0; c < channels; ++c)
    values.push_back(json_number(layer.values[pixel * channels + c]));
  return values;
}

/// What is under a place in the picture, 0 to 1 from its top left corner: the values of every layer, and
/// where a surface of a scene with an outline is there, its place, the object's name, and the centre and
/// radius of the object's box.
ordered_json pixel_report(const renderer::Picture& picture, const SceneOutline* outline, double x, double y) {
  const int column = std::min(static_cast<int>(x * picture.width), picture.width - 1);
  const int row = std::min(static_cast<int>(y * picture.height), picture.height - 1);
  const std::size_t pixel = static_cast<std::size_t>(row) * static_cast<std::size_t>(picture.width) +
                            static_cast<std::size_t>(column);
  ordered_json json{{"x", column}, {"y", row}};
  ordered_json layers;
  for (const renderer::Layer& layer : picture.layers)
    layers[layer.name.empty() ? "radiance" : layer.name] = values_at(layer, pixel);
  json["layers"] = layers;
  const renderer::Layer* instances = picture.find(renderer::enum_name(renderer::Aov::instance_id));
  const renderer::Layer* positions = picture.find(renderer::enum_name(renderer::Aov::position));
  if (!outline || !instances || !positions) return json;
  const float number = instances->values[pixel];
  if (!(number >= 0.0f) || static_cast<std::size_t>(number) >= outline->instances.size()) return json;
  const auto instance = static_cast<std::size_t>(number);
  json["object"] = outline->instances[instance];
  json["position"] = values_at(*positions, pixel);
  if (const std::optional<Box> box = outline->object_around(instance)) {
    const Vec3 center = box->center();
    json["center"] = {center.x(), center.y(), center.z()};
    json["radius"] = 0.5f * box->diagonal().norm();
  }
  return json;
}

/// Where a wide picture is made, and the page asks for a layer that drafts lack, the last whole one is shown.
const renderer::Picture* picture_with(const ShownPicture* shown, const std::string& layer) {
  if (!shown || (!layer.empty() && shown->picture.find(layer) == nullptr)) return nullptr;
  return &shown->picture;
}

}  // namespace

WebResponse ViewApi::answer(const WebRequest& request) {
  try {
    if (WebResponse file = page_file(request.path); request.method == "GET" && file.status == 200)
      return file;
    return route(request, viewer_of(request));
  } catch (const BadOption& error) {
    return error_response(400, error.what());
  } catch (const nlohmann::json::exception&) {
    return error_response(400, "the request: expected JSON as the page sends it");
  } catch (const std::exception&) {
    return error_response(500, describe_current_exception().message);
  }
}

WebResponse ViewApi::route(const WebRequest& request, const std::string& viewer) {
  const std::string& path = request.path;
  if (request.method == "POST") {
    if (path == "api/change") return change(request, viewer);
    return error_response(404, "there is no such request");
  }
  if (path == "api/scene") return scene(viewer);
  if (path == "api/picture") return picture(request, viewer);
  if (path == "api/status") return status(viewer);
  if (path == "api/pixel") return pixel(request, viewer);
  if (path == "api/save") return save(request, viewer);
  return error_response(404, "there is no such request");
}

WebResponse ViewApi::scene(const std::string& viewer) {
  ordered_json words = ordered_json::object();
  for (const std::string& word : source_.words()) {
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) words[word.substr(2, equals - 2)] = word.substr(equals + 1);
  }
  ordered_json curves = ordered_json::array();
  for (const auto& [name, curve] : renderer::kEnumNames<renderer::Tonemap>) curves.push_back(name);
  ordered_json json{
      {"file", source_.file()}, {"given", words}, {"flags", source_.flags(viewer)}, {"curves", curves}};
  if (const SceneOutline* outline = source_.outline()) {
    json["layers"] = describe_layers(nullptr);
    json.update(outline->json);
  } else if (const auto shown = source_.last_whole(viewer)) {
    json["layers"] = describe_layers(&shown->picture);
  }
  return json_response(json);
}

WebResponse ViewApi::change(const WebRequest& request, const std::string& viewer) {
  const ordered_json json = ordered_json::parse(request.body);
  FlagChange flags;
  if (json.contains("flags")) {
    for (const auto& [name, value] : json.at("flags").items())
      flags[name] = value.is_null() ? std::nullopt : std::optional(value.get<std::string>());
  }
  const std::string layer = json.value("layer", "");
  return json_response({{"revision", source_.change(viewer, flags, layer)}});
}

WebResponse ViewApi::picture(const WebRequest& request, const std::string& viewer) {
  const std::string layer = parameter(request, "layer");
  const auto after = static_cast<std::uint64_t>(parse_integer("after", parameter(request, "after"), {}));
  const auto shown = source_.wait(viewer, after, kLongestWait);
  if (!shown) return {.status = 204};
  const auto whole = source_.last_whole(viewer);
  const renderer::Picture* picture = picture_with(shown.get(), layer);
  if (!picture) picture = picture_with(whole.get(), layer);
  // The layer comes with the next whole picture.
  if (!picture) picture = &shown->picture;
  const std::string present = picture->find(layer) != nullptr ? layer : "";
  const std::vector<std::uint8_t> bytes = layer_bytes(*picture, present, display_of(*shown));
  const bool exact = shown->complete || !present.empty();
  const std::vector<std::uint8_t> file =
      exact ? encode_png(bytes, picture->width, picture->height, 3)
            : encode_jpeg(bytes, picture->width, picture->height, kJpegQuality);
  ordered_json description = describe(*shown);
  description["histogram"] = histogram(bytes);
  description["layer"] = present;
  return {.type = exact ? "image/png" : "image/jpeg",
          .body = std::string(file.begin(), file.end()),
          .headers = {{"X-Picture", description.dump()}}};
}

WebResponse ViewApi::status(const std::string& viewer) {
  const ViewerStatus status = source_.status(viewer);
  const auto whole = source_.last_whole(viewer);
  const renderer::Progress& p = status.progress;
  ordered_json json{{"revision", status.revision},
                    {"version", status.version},
                    {"stage", name_of_stage(status.stage)},
                    {"complete", status.complete},
                    {"waits", status.waits},
                    {"phase", word_of(p.phase)},
                    {"fraction", p.fraction},
                    {"steps", p.steps_done},
                    {"all_steps", p.steps},
                    {"loss", p.loss},
                    {"samples", p.samples},
                    {"spp", p.spp},
                    {"error", status.error}};
  if (whole) {
    const renderer::RenderStatistics& s = whole->statistics;
    json["last"] = {{"spp", s.spp},
                    {"samples_per_second",
                     s.render_seconds > 0.0 ? static_cast<double>(s.samples) / s.render_seconds : 0.0},
                    {"loss", s.cache.loss},
                    {"training_steps", s.cache.steps},
                    {"cache_bytes", s.cache.parameter_bytes + s.cache.optimizer_bytes + s.cache.layout_bytes},
                    {"scene_bytes", s.geometry_bytes + s.bvh_bytes + s.texture_bytes + s.light_bytes},
                    {"light_change", s.cache.light_change}};
    if (s.estimated_error) json["last"]["estimated_error"] = *s.estimated_error;
  }
  json["command"] = source_.command(viewer);
  return json_response(json);
}

WebResponse ViewApi::pixel(const WebRequest& request, const std::string& viewer) {
  const auto whole = source_.last_whole(viewer);
  if (!whole) return json_response(ordered_json::object());
  return json_response(
      pixel_report(whole->picture, source_.outline(), place(request, "x"), place(request, "y")));
}

WebResponse ViewApi::save(const WebRequest& request, const std::string& viewer) {
  const std::string format = parameter(request, "format");
  if (format != "exr" && format != "png") throw BadOption({"format", format, "", "exr or png"});
  const auto whole = source_.last_whole(viewer);
  if (!whole) return error_response(404, "there is no picture yet");
  renderer::Picture picture = whole->picture;
  RunReport report;
  report.command = {source_.command(viewer)};
  const renderer::ImageWriteOptions options =
      finish_picture(picture, whole->settings, whole->statistics, whole->seconds, report);
  const bool exr = format == "exr";
  const auto bytes =
      renderer::encode_image(picture, exr ? renderer::ImageFormat::exr : renderer::ImageFormat::png, options);
  return {.type = exr ? "image/x-exr" : "image/png",
          .body = std::string(bytes.begin(), bytes.end()),
          .headers = {{"Content-Disposition", "attachment; filename=gatelight." + format}}};
}

}  // namespace gatelight::apps
