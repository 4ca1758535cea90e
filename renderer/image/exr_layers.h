#pragma once
// Where the layers of a picture are in an EXR file, for its reader and its writer.

#include <Imath/ImathBox.h>
#include <Imath/half.h>
#include <OpenEXR/ImfMultiPartInputFile.h>

#include <string>
#include <vector>

#include "renderer/image/picture.h"

namespace gatelight::renderer {

struct StoredLayer {
  Layer layer;  ///< without values; its channels have their usual names
  int part = 0;
  std::vector<std::string> channels;  ///< their full names in the part
};

/// The layers of all flat parts that have pixels where the first part has them; the picture that is shown
/// comes first. Throws std::exception.
std::vector<StoredLayer> find_layers(const Imf::MultiPartInputFile& file);

/// The address of the pixel (0, 0), to which the library adds the offset of the data window, of a plane that
/// begins at `base`. The window may lie anywhere, so it is an integer that may wrap.
char* origin(const void* base, std::size_t pixel_bytes, std::size_t row_bytes, const Imath::Box2i& data);

/// Keeps finite radiance finite. The conversion of `half` turns values beyond its range into infinity.
half to_half(float value);

}  // namespace gatelight::renderer
