#pragma once
// The options that decide a picture's bits, as texts under the names of their flags. They must be equal where
// a picture is resumed.

#include "renderer/fingerprint/named_texts.h"
#include "renderer/settings/options.h"
#include "renderer/settings/view.h"

namespace gatelight::renderer {

/// `view` is the chosen one. `machine` names the chosen instruction sets (of Embree, of the cache's
/// kernels), which change the last digits. Threads, memory limit, outputs, time limits, checkpoints, the
/// treatment of samples that are not finite, and spp, which may grow, are left out. Options of the cache are
/// included for integrators that use one.
NamedTexts deciding_options(const RenderOptions& options, const View& view, const NamedTexts& machine);

}  // namespace gatelight::renderer
