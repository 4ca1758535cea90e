#pragma once
// A picture in memory: named layers of floats and metadata.

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace gatelight::renderer {

struct Layer {
  std::string name;                   ///< empty for the beauty layer, whose channels are R, G, B
  std::vector<std::string> channels;  ///< "R","G","B" | "X","Y","Z" | "Z" | "id" ...
  std::vector<float> values;          ///< width * height * channels, interleaved; the first row is the top
  bool full_precision = false;        ///< always written as 32-bit float (ids, depth, position)

  /// Whether the last channel is A. The colours are then premultiplied by it.
  bool has_alpha() const { return channels.back() == "A"; }
};

/// Transforms from the coordinates of the scene's file, in metres, to the picture. Column-major, for column
/// vectors.
struct ViewMatrices {
  std::array<float, 16> world_to_camera;  ///< x right, y up, z into the picture
  std::array<float, 16> world_to_ndc;     ///< (0, 0) top left to (1, 1) bottom right of the full picture
};

struct Picture {
  int width = 0;  ///< in pixels, of the stored part
  int height = 0;
  int x0 = 0;  ///< place of the stored pixels in the full picture (the EXR's data window)
  int y0 = 0;
  int full_width = 0;  ///< of the full picture (the EXR's display window); 0 means equal to width and height
  int full_height = 0;
  std::vector<Layer> layers;  ///< the first one is the beauty layer
  std::map<std::string, std::string>
      metadata;  ///< how the picture was made; in the EXR header as "gatelight:KEY"
  std::map<std::string, std::string> attributes;  ///< copied to the EXR header (cryptomatte.h)

  std::optional<ViewMatrices> view;  ///< in the EXR header as worldToCamera and worldToNDC

  const Layer* find(const std::string& name) const {
    for (const Layer& layer : layers) {
      if (layer.name == name) return &layer;
    }
    return nullptr;
  }
};

}  // namespace gatelight::renderer
