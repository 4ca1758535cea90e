#pragma once
// Whether a graphics device makes the steps of a cache faster than the processor.

#include <memory>

#include "neural/model/backend.h"
#include "renderer/settings/options.h"
#include "renderer/settings/statistics.h"

namespace gatelight::renderer {

/// Opening a device and compiling its shaders takes about this long. Where the processor's steps take less
/// together, no device is opened.
inline constexpr double kDeviceStartSeconds = 0.5;

/// The decision: a device has to be faster by a quarter, so that noise seldom changes it.
bool device_is_faster(const DeviceTrial& trial);

/// For CacheOptions::choose_device: the CPU's backend, or that of the best device (no software device) if
/// some steps are faster there. `trial` tells the times if a device was tried. Costs nothing without a
/// device. Runs in the caller's arena.
std::unique_ptr<neural::Backend> choose_cache_backend(std::shared_ptr<const neural::Model> model,
                                                      const RenderOptions& options,
                                                      std::optional<DeviceTrial>& trial);

}  // namespace gatelight::renderer
