#pragma once
// Picture files for tests of the program.

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"

namespace gatelight::tests {

/// An EXR in which every number is `value`.
inline std::string write_even(const std::filesystem::path& file, int width, int height, float value,
                              std::map<std::string, std::string> metadata = {}) {
  renderer::Picture picture{.width = width, .height = height, .metadata = std::move(metadata)};
  picture.layers = {{.channels = {"R", "G", "B"},
                     .values = std::vector<float>(static_cast<std::size_t>(3 * width * height), value)}};
  renderer::write_image(picture, file, {.exr_float = true});
  return file.string();
}

/// The colours of the first layer.
inline std::vector<float> beauty_of(const std::filesystem::path& file) {
  return renderer::read_image(file).layers.front().values;
}

}  // namespace gatelight::tests
