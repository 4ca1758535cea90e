#pragma once
// A finished picture: named layers of floats with a recipe. What files are made of.

#include <map>
#include <string>
#include <vector>

namespace gatelight::renderer {

struct Layer {
  std::string name;                   ///< empty for the beauty layer, whose channels are R, G, B
  std::vector<std::string> channels;  ///< "R","G","B" | "X","Y","Z" | "Z" | "id" ...
  std::vector<float> values;          ///< interleaved, width * height * channels, rows from the top
  bool full_precision = false;  ///< written as 32-bit float whatever the options say (ids, depth, position)
};

struct Picture {
  int width = 0;  ///< of the pixels stored here
  int height = 0;
  int x0 = 0;  ///< where they lie in the full picture: a region keeps its place (the EXR's data window)
  int y0 = 0;
  int full_width = 0;  ///< of the full picture (the EXR's display window); 0: the same as width and height
  int full_height = 0;
  std::vector<Layer> layers;  ///< the first is the beauty layer
  std::map<std::string, std::string>
      metadata;  ///< the recipe, written into the EXR header under "gatelight:KEY"

  const Layer* find(const std::string& name) const {
    for (const Layer& layer : layers) {
      if (layer.name == name) return &layer;
    }
    return nullptr;
  }
};

}  // namespace gatelight::renderer
