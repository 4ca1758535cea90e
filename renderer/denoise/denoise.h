#pragma once
// Denoises a picture band by band, so that memory stays bounded, and scales it to its size.

#include <optional>
#include <vector>

#include "renderer/denoise/denoiser.h"
#include "renderer/denoise/exposure.h"
#include "renderer/film/scale_down.h"

namespace gatelight::renderer {

/// A picture with noise, of which rows are read when they are needed.
struct NoisyPicture {
  int width = 0;   ///< a multiple of the factor by which it is scaled
  int height = 0;  ///< the same
  ReadRows color;
  ReadRows albedo;                        ///< empty: no guides
  ReadRows normal;                        ///< the same
  ReadRows alpha;                         ///< 1 float a pixel; empty: none
  std::optional<PixelRect> noisy_guides;  ///< NoisyImage::noisy_guides
};

/// Rows of a denoised picture.
struct DenoisedRows {
  std::vector<float> color;  ///< 3 floats a pixel, not negative
  std::vector<float> alpha;  ///< 1 float a pixel, 0 to 1; empty where the noisy picture has none
};

/// The rows begin <= y < end of a scaled picture.
struct RowsToDenoise {
  int begin = 0;
  int end = 0;
  int margin = 128;  ///< rows before scaling that are read around them; the networks see no more
};

/// Some denoised rows. With the usual margin each is that of the whole picture but for rounding. Empty where
/// `progress` cancelled.
std::optional<DenoisedRows> denoise_rows(Denoiser& denoiser, const NoisyPicture& picture,
                                         const RowsToDenoise& rows, const FilterOptions& options,
                                         const ScaleDown& scale, const DenoiseProgress& progress = {});

/// The rows of the scaled picture that denoise() takes at a time, to bound memory. `width` and `height` are
/// those of the picture before scaling.
int rows_of_band(int width, int height, const ScaleDown& scale);

/// Sets up what denoise() needs for a picture that is taken at a time (Denoiser::prepare).
void prepare_denoise(Denoiser& denoiser, int width, int height, const FilterOptions& options, bool guides,
                     const ScaleDown& scale, const std::optional<PixelRect>& noisy_guides = {});

/// All rows, with exposure_of() the picture as FilterOptions::scale.
std::optional<DenoisedRows> denoise(Denoiser& denoiser, const NoisyPicture& picture, FilterOptions options,
                                    const ScaleDown& scale, const DenoiseProgress& progress = {});

}  // namespace gatelight::renderer
