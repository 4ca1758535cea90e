#pragma once
// Composites a picture over its background.

#include "renderer/image/picture.h"
#include "renderer/settings/background_options.h"

namespace gatelight::renderer {

/// Throws what put_before() would throw of the background's file, for a full picture of this size.
void check_background(const BackgroundOptions& background, int width, int height);

/// `alpha`: a value for each pixel, of a picture whose colours have no background yet. Afterwards the beauty
/// layer has it as channel A, colours multiplied by it; or the background is added and there is no A. Porter
/// and Duff's "over" (1984). Throws what read_image() throws for the background's file, and
/// MissingLibrary if it must be scaled and OpenImageIO cannot be loaded.
void put_before(Picture& picture, const std::vector<float>& alpha, const BackgroundOptions& background);

}  // namespace gatelight::renderer
