#include "renderer/denoise/layers_to_denoise.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <iterator>

#include "base/errors.h"
#include "renderer/image/color_channels.h"
#include "renderer/image/layer_names.h"

namespace gatelight::renderer {
namespace {

constexpr const char* kNone = "none";

bool same_word(const std::string& a, const std::string& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// Whether the layer's channels suit its role.
bool suits(const Layer& layer, LayerRole role) {
  return role == LayerRole::normal ? vector_channels(layer).has_value() : color_channels(layer).has_value();
}

/// The layer of that name, in any case if there is none in this one.
const Layer& named_layer(const Picture& picture, const std::string& name, LayerRole role) {
  const Layer* found = picture.find(name);
  for (const Layer& layer : picture.layers) {
    if (!found && same_word(layer.name, name)) found = &layer;
  }
  if (!found) throw InputError(fmt::format("has no layer '{}'", name));
  if (suits(*found, role)) return *found;
  throw InputError(role == LayerRole::normal
                       ? fmt::format("has a layer '{}' with the channels {}, expected X, Y and Z", name,
                                     fmt::join(found->channels, ", "))
                       : fmt::format("has a layer '{}' with the {}", name, describe_channels(*found)));
}

class Chooser {
 public:
  explicit Chooser(const Picture& picture) : layers_(picture.layers) {
    for (const Layer& layer : layers_) meanings_.push_back(meaning_of(layer.name));
  }

  /// The layer of a role with the first of the usual names, in one group or in any.
  const Layer* find(LayerRole role, const std::string* group) const {
    const Layer* best = nullptr;
    int rank = 0;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const LayerMeaning& meaning = meanings_[i];
      if (meaning.role != role || (group && meaning.group != *group) || !suits(layers_[i], role)) continue;
      if (best && meaning.rank >= rank) continue;
      best = &layers_[i];
      rank = meaning.rank;
    }
    return best;
  }

  /// Names the guides of a view layer; `group`: null for those of any.
  void add_guides(LayersToDenoise& layers, const std::string* group) const {
    layers.albedo = name(LayerRole::albedo, group);
    layers.normal = name(LayerRole::normal, group);
  }

  /// The groups with colours, that of the picture that is shown first.
  std::vector<std::string> groups() const {
    std::vector<std::string> groups;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
      const LayerMeaning& meaning = meanings_[i];
      if (i > 0 && meaning.role != LayerRole::beauty && meaning.role != LayerRole::noisy) continue;
      if (!color_channels(layers_[i]) ||
          std::find(groups.begin(), groups.end(), meaning.group) != groups.end())
        continue;
      groups.push_back(meaning.group);
    }
    return groups;
  }

  LayersToDenoise of_group(const std::string& group) const {
    const Layer* noisy = find(LayerRole::noisy, &group);
    const Layer* beauty = find(LayerRole::beauty, &group);
    const Layer& shown = layers_.front();
    if (!beauty && !noisy && color_channels(shown)) beauty = &shown;
    LayersToDenoise layers{.color = (noisy ? noisy : beauty)->name,
                           .result = (beauty ? beauty : noisy)->name};
    add_guides(layers, &group);
    return layers;
  }

 private:
  std::optional<std::string> name(LayerRole role, const std::string* group) const {
    const Layer* const layer = find(role, group);
    return layer ? std::optional(layer->name) : std::nullopt;
  }

  const std::vector<Layer>& layers_;
  std::vector<LayerMeaning> meanings_;
};

/// The view layers that have a guide, or the one that is shown.
std::vector<LayersToDenoise> usual_layers(const Picture& picture) {
  const Chooser chooser(picture);
  const std::vector<std::string> groups = chooser.groups();
  if (groups.empty())
    throw InputError(fmt::format("has no colours: its layer '{}' has the {}", picture.layers.front().name,
                                 describe_channels(picture.layers.front())));
  std::vector<LayersToDenoise> all;
  for (const std::string& group : groups) all.push_back(chooser.of_group(group));
  std::vector<LayersToDenoise> guided;
  std::copy_if(all.begin(), all.end(), std::back_inserter(guided),
               [](const LayersToDenoise& layers) { return layers.has_guides(); });
  if (!guided.empty()) return guided;
  chooser.add_guides(all.front(), nullptr);
  return {all.front()};
}

/// Colours that are named, with the guides of their view layer, or else of any.
LayersToDenoise named_layers(const Picture& picture, const std::string& name) {
  const std::string color = named_layer(picture, name, LayerRole::beauty).name;
  const std::string group = meaning_of(color).group;
  LayersToDenoise layers{.color = color, .result = color};
  const Chooser chooser(picture);
  chooser.add_guides(layers, &group);
  if (!layers.has_guides()) chooser.add_guides(layers, nullptr);
  return layers;
}

void name_guide(const Picture& picture, const std::string& name, LayerRole role,
                std::optional<std::string>& guide) {
  if (name == kNone)
    guide.reset();
  else if (!name.empty())
    guide = named_layer(picture, name, role).name;
}

}  // namespace

std::vector<LayersToDenoise> layers_to_denoise(const Picture& picture, const LayerNames& names) {
  const auto is_usual = [](const std::string& name) { return name.empty() || name == kNone; };
  std::vector<LayersToDenoise> chosen;
  if (has_denoising_layers(picture) && names.color.empty() && is_usual(names.albedo) &&
      is_usual(names.normal)) {
    const Layer& shown = picture.layers.front();
    if (is_denoising_layer(shown.name) || !color_channels(shown))
      throw InputError("has no picture besides the layers of --aov denoising");
    chosen = {own_layers(picture)};
  } else if (names.color.empty()) {
    chosen = usual_layers(picture);
  } else {
    chosen = {named_layers(picture, names.color)};
  }
  const bool single = chosen.size() == 1;
  for (LayersToDenoise& layers : chosen) {
    const auto of_it = [&](const std::string& name) {
      return single || name == kNone || meaning_of(name).group == meaning_of(layers.color).group;
    };
    if (of_it(names.albedo)) name_guide(picture, names.albedo, LayerRole::albedo, layers.albedo);
    if (of_it(names.normal)) name_guide(picture, names.normal, LayerRole::normal, layers.normal);
  }
  return chosen;
}

std::vector<std::string> colors_left(const Picture& picture, const std::vector<LayersToDenoise>& chosen) {
  std::vector<std::string> left;
  for (const Layer& layer : picture.layers) {
    if (meaning_of(layer.name).role != LayerRole::beauty || !color_channels(layer)) continue;
    if (std::none_of(chosen.begin(), chosen.end(), [&](const auto& c) { return c.result == layer.name; }))
      left.push_back(layer.name);
  }
  return left;
}

}  // namespace gatelight::renderer
