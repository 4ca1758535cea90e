#pragma once
// Packets of the network protocol of the image viewer tev, as its README and its client in Python
// (tevclient) describe them.

#include <string>

#include "renderer/image/picture.h"

namespace gatelight::apps {

inline constexpr int kTevPort = 14158;

/// The name of a layer's channel: "R" of the beauty layer, "albedo.R" of others.
std::string tev_channel(const renderer::Layer& layer, std::size_t channel);

/// CreateImage: an image of this name with all channels of the picture and its full size. tev selects it.
std::string tev_create_image(const std::string& name, const renderer::Picture& picture);

/// UpdateImage, version 3: rows begin <= row < end of one layer.
std::string tev_update_image(const std::string& name, const renderer::Picture& picture,
                             const renderer::Layer& layer, int begin, int end);

}  // namespace gatelight::apps
