// Requests to the page of `gatelight view`, one after the other: a line "METHOD path?name=value&name=value",
// then the body up to a byte 0x1e. A finished picture answers; changed flags are also read as those of a
// scene are.

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "apps/settings/parsing.h"
#include "apps/terminal/errors.h"
#include "apps/view/live_flags.h"
#include "apps/view/picture_file.h"
#include "apps/view/view_api.h"
#include "base/errors.h"
#include "renderer/image/image_write.h"
#include "tests/fuzz/input_file.h"

namespace gatelight::fuzz {
namespace {

constexpr std::size_t kMaxRequests = 8;

/// A small picture with a second layer.
apps::PictureFile& source() {
  static const tests::TemporaryFolder folder;
  static apps::PictureFile file(
      [] {
        renderer::Picture picture{.width = 4, .height = 3};
        picture.layers = {{.name = "", .channels = {"R", "G", "B"}}, {.name = "depth", .channels = {"Z"}}};
        for (renderer::Layer& layer : picture.layers) layer.values.assign(12 * layer.channels.size(), 0.5f);
        const std::string path = (folder / "a.exr").string();
        renderer::write_image(picture, path, {});
        return path;
      }(),
      {"--exposure=auto"});
  return file;
}

apps::WebRequest request_of(std::string_view text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string line(text.substr(0, end));
  apps::WebRequest request;
  const std::size_t blank = std::min(line.find(' '), line.size());
  request.method = line.substr(0, blank);
  const std::string address = blank < line.size() ? line.substr(blank + 1) : "";
  const std::size_t question = std::min(address.find('?'), address.size());
  request.path = address.substr(0, question);
  if (question < address.size()) {
    for (const std::string& part : apps::split(address.substr(question + 1), '&')) {
      const std::size_t equals = std::min(part.find('='), part.size());
      request.query[part.substr(0, equals)] = equals < part.size() ? part.substr(equals + 1) : "";
    }
  }
  if (end < text.size()) request.body = text.substr(end + 1);
  return request;
}

/// As the session of a scene does.
void read_flags(const std::string& body) {
  const nlohmann::json json = nlohmann::json::parse(body, nullptr, false);
  if (!json.is_object() || !json.contains("flags") || !json["flags"].is_object()) return;
  apps::FlagChange change;
  for (const auto& [name, value] : json["flags"].items()) {
    if (value.is_null()) change[name] = std::nullopt;
    if (value.is_string()) change[name] = value.get<std::string>();
  }
  try {
    const apps::LiveFlags flags = apps::changed({}, change);
    apps::render_command("a.glb", {"--spp=4"}, flags);
    apps::settings_of("a.glb", {"--spp=4"}, flags);
  } catch (const BadOption& error) {
    check_line(one_line(error.what()));
  }
}

}  // namespace

void view_request(Bytes bytes) {
  std::string_view rest(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  apps::ViewApi api(source());
  for (std::size_t i = 0; i < kMaxRequests && !rest.empty(); ++i) {
    const std::size_t end = std::min(rest.find('\x1e'), rest.size());
    apps::WebRequest request = request_of(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (request.path == "api/picture") request.query["after"] = "0";  // it would wait for a newer one
    const apps::WebResponse response = api.answer(request);
    if (response.status != 200 && response.status != 400 && response.status != 404)
      throw Violation("status " + std::to_string(response.status) + ": " + response.body);
    if (response.status != 200) check_line(nlohmann::json::parse(response.body).at("error"));
    if (response.status == 200 && response.type.starts_with("application/json") &&
        !nlohmann::json::accept(response.body))
      throw Violation("an answer that is no JSON: " + response.body);
    read_flags(request.body);
  }
}

}  // namespace gatelight::fuzz
