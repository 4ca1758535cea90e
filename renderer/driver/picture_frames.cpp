#include "renderer/driver/picture_frames.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/reuse/picture_history.h"

namespace gatelight::renderer {
namespace {

/// A channel of each pixel; what is not finite is 0.
std::vector<float> plane_of(const Layer& layer, std::size_t channel) {
  std::vector<float> plane;
  plane.reserve(layer.values.size() / layer.channels.size());
  for (std::size_t i = channel; i < layer.values.size(); i += layer.channels.size())
    plane.push_back(std::isfinite(layer.values[i]) ? layer.values[i] : 0.0f);
  return plane;
}

/// Two floats a pixel: x right, y up, pixels since the frame before. Ours has two channels; X and Y of
/// Blender's four lead back to where the surface was.
std::vector<float> motion_of(const Layer& layer) {
  const bool leads_back = layer.channels.size() > 2;
  const std::vector<float> x = plane_of(layer, 0), y = plane_of(layer, 1);
  std::vector<float> motion;
  motion.reserve(2 * x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    motion.insert(motion.end(), {leads_back ? -x[i] : x[i], leads_back ? -y[i] : y[i]});
  return motion;
}

FrameLayers layers_of_frame(const Picture& picture, const LayersToDenoise& layers, const Samples& samples) {
  FrameLayers frame{.rect = {picture.x0, picture.y0, picture.x0 + picture.width, picture.y0 + picture.height},
                    .color = samples.color,
                    .albedo = samples.albedo,
                    .normal = samples.normal};
  if (layers.depth) frame.depth = plane_of(*picture.find(*layers.depth), 0);
  if (layers.object) frame.object = plane_of(*picture.find(*layers.object), 0);
  if (layers.motion) frame.motion = motion_of(*picture.find(*layers.motion));
  return frame;
}

}  // namespace

void mix_earlier_frame(const Picture& picture, const LayersToDenoise& layers, const Samples& samples,
                       EarlierFrame& earlier, std::vector<float>& denoised) {
  if (samples.factor != 1 || !layers.motion) return;
  FrameLayers frame = layers_of_frame(picture, layers, samples);
  std::shared_ptr<PictureHistory>& history = earlier.light[layers.result];
  CarriedLight carried = carry_picture(frame, denoised, history.get());
  mix_light(carried, frame.rect, denoised);
  frame.color.clear();
  history = std::make_shared<PictureHistory>(
      PictureHistory{std::move(frame), denoised, std::move(carried.samples)});
  earlier.share = carried.share;
}

}  // namespace gatelight::renderer
