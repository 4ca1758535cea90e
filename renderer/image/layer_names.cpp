#include "renderer/image/layer_names.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <string_view>
#include <utility>

namespace gatelight::renderer {
namespace {

struct UsualName {
  std::string_view name;
  LayerRole role;
};

/// In lower case, without spaces, hyphens and underscores. Of one role the first comes first.
constexpr UsualName kUsual[] = {
    {"noisyimage", LayerRole::noisy},        // Blender
    {"raw", LayerRole::noisy},               // ours
    {"", LayerRole::beauty},                 //
    {"combined", LayerRole::beauty},         // Blender
    {"rgba", LayerRole::beauty},             //
    {"beauty", LayerRole::beauty},           //
    {"c", LayerRole::beauty},                // Karma
    {"denoisingalbedo", LayerRole::albedo},  // Blender, ours
    {"denoisealbedo", LayerRole::albedo},    // Arnold
    {"albedo", LayerRole::albedo},           //
    {"denoisingnormal", LayerRole::normal},  // Blender, ours
    {"denoisenormal", LayerRole::normal},    //
    {"normal", LayerRole::normal},           //
    {"normals", LayerRole::normal},          //
    {"n", LayerRole::normal},                // Arnold, Karma
    {"ns", LayerRole::normal},               // pbrt
    {"shnormal", LayerRole::normal},         // Mitsuba
};

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

std::string plain(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    if (c != ' ' && c != '-' && c != '_') plain += lower(c);
  }
  return plain;
}

}  // namespace

LayerMeaning meaning_of(const std::string& layer) {
  std::string name = layer, eye;
  const auto split = [](std::string& text) {
    const std::size_t dot = text.rfind('.');
    std::string last = dot == std::string::npos ? std::exchange(text, "") : text.substr(dot + 1);
    if (dot != std::string::npos) text.resize(dot);
    return last;
  };
  if (name.ends_with(".left") || name.ends_with(".right")) eye = split(name);
  const std::string pass = plain(split(name));
  std::string group = name + (name.empty() || eye.empty() ? "" : ".") + eye;
  const auto found = std::find_if(std::begin(kUsual), std::end(kUsual), [&](const UsualName& usual) {
    return usual.name == pass && (!usual.name.empty() || layer.empty());
  });
  if (found == std::end(kUsual)) return {.group = std::move(group)};
  return {found->role, static_cast<int>(found - std::begin(kUsual)), std::move(group)};
}

std::string usual_channel(const std::string& channel) {
  constexpr std::pair<std::string_view, const char*> kWords[] = {
      {"red", "R"}, {"green", "G"}, {"blue", "B"}, {"alpha", "A"}};
  constexpr std::string_view kLetters = "rgbaxyz";
  const std::string name = plain(channel);
  for (const auto& [word, usual] : kWords) {
    if (name == word) return usual;
  }
  if (channel.size() == 1 && kLetters.find(name) != std::string_view::npos)
    return std::string(1, static_cast<char>(std::toupper(static_cast<unsigned char>(channel[0]))));
  return channel;
}

}  // namespace gatelight::renderer
