#pragma once
// The frames of an animation in one call of `gatelight render`: for each camera that is asked for, one after
// the other, or dealt to groups of processes.

#include "apps/render/stills.h"
#include "scene/gltf.h"

namespace gatelight::apps {

/// Returns the exit code. A frame that fails does not keep the others from being rendered: the first failure
/// is thrown after them.
int render_frames(const RenderSettings& settings, scene::SceneFile& file, scene::Scene& scene,
                  PictureMaker& maker);

}  // namespace gatelight::apps
