#pragma once
// A picture in Python.

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "renderer/image/image_write.h"
#include "renderer/image/picture.h"

namespace gatelight::python {

struct PictureData {
  renderer::Picture picture;
  renderer::ImageWriteOptions image;
  std::string statistics = "{}";  ///< JSON
  std::vector<std::string> warnings;
};

using PicturePointer = std::shared_ptr<PictureData>;

/// A picture, a file's name, or an array (h, w, 3) or (h, w). Throws BadOption or what read_image() throws.
PicturePointer picture_of(const char* name, pybind11::handle value);

/// The layer of an array (h, w) or (h, w, c), by the names of its channels.
renderer::Layer layer_of(const char* name, pybind11::handle values, const char* layer, int& width,
                         int& height);

}  // namespace gatelight::python
