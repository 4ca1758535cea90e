#pragma once
// Light that is carried from frame to frame where only the layers of their files tell what they show.

#include <vector>

#include "renderer/reuse/carried_light.h"

namespace gatelight::renderer {

/// Layers of a frame, by pixel, in rows from the top. All but the colours may be empty.
struct FrameLayers {
  PixelRect rect;             ///< its place in the full picture
  std::vector<float> color;   ///< 3 floats: the samples, with noise
  std::vector<float> albedo;  ///< 3 floats
  std::vector<float> normal;  ///< 3 floats, in a space that hardly turns between two frames
  std::vector<float> depth;   ///< 1 float
  std::vector<float> object;  ///< 1 float: the number of what is seen
  std::vector<float> motion;  ///< 2 floats: x right, y up, pixels since the frame before
};

/// A frame, for the next one.
struct PictureHistory {
  FrameLayers layers;          ///< without colours
  std::vector<float> color;    ///< 3 floats: the finished light
  std::vector<float> samples;  ///< 1 float: how many frames they have; 0 near edges
};

/// Finds the light of the frame before where its pixel shows the same surface: its object, normal and albedo,
/// and about its depth. The light is compared as that of our own frames, by the noise that the denoiser has
/// taken out of 9 x 9 pixels. `denoised`: 3 floats a pixel. `history`: null for none. A frame without motion
/// takes nothing over. Works in the caller's arena.
CarriedLight carry_picture(const FrameLayers& frame, const std::vector<float>& denoised,
                           const PictureHistory* history);

}  // namespace gatelight::renderer
