#pragma once
// The options that decide a picture's bits, as texts under the names of their flags: what must be equal where
// a picture is gone on with.

#include "renderer/identity/named_texts.h"
#include "renderer/settings/options.h"
#include "scene/scene.h"

namespace gatelight::renderer {

/// `camera` is the one that was chosen; `machine` names the instruction sets that were (of Embree, of the
/// cache's kernels), as different ones differ in the last digits. Left out: threads, memory limit, outputs,
/// time limits, checkpoints, what happens to a sample that is not finite, and spp, which may grow. Options of
/// the cache are in it for the integrators that use one.
NamedTexts deciding_options(const RenderOptions& options, const scene::Camera& camera,
                            const NamedTexts& machine);

}  // namespace gatelight::renderer
