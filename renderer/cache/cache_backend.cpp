#include "renderer/cache/cache_backend.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>

#include "base/errors.h"
#include "neural/cpu/cpu_backend.h"
#include "neural/vulkan/vulkan_backend.h"
#include "renderer/cache/cache_model.h"

namespace gatelight::renderer {
namespace {

std::optional<simd::Isa> forced_isa(const RenderOptions& options) {
  if (options.isa == "auto") return std::nullopt;
  return simd::parse_isa(options.isa);
}

constexpr std::string_view kVulkan = "vulkan";

/// The device named after "vulkan:"; nothing for the CPU.
std::optional<std::string> vulkan_device(const RenderOptions& options) {
  const std::string_view device = options.cache.device;
  if (device == "cpu") return std::nullopt;
  if (device == kVulkan) return "";
  if (device.starts_with(kVulkan) && device.size() > kVulkan.size() && device[kVulkan.size()] == ':')
    return std::string(device.substr(kVulkan.size() + 1));
  throw Unavailable({"device", std::string(device), "", "cpu or vulkan"});
}

/// Rethrows Unavailable of `neural` about the option.
template <typename Function>
auto on_device(const RenderOptions& options, Function function) {
  try {
    return function();
  } catch (const Unavailable& error) {
    if (options.cache.device == "cpu") throw Unavailable(error.what());
    throw Unavailable({"device", options.cache.device, fmt::format("cannot be used: {}", error.what())});
  }
}

}  // namespace

std::unique_ptr<neural::Backend> make_cache_backend(std::shared_ptr<const neural::Model> model,
                                                    const RenderOptions& options) {
  return on_device(options, [&]() -> std::unique_ptr<neural::Backend> {
    const neural::TrainingOptions training = training_options(options);
    if (const std::optional<std::string> device = vulkan_device(options))
      return neural::vulkan::make_vulkan_backend(neural::vulkan::open_machine({.device = *device}),
                                                 std::move(model), training);
    return neural::cpu::make_cpu_backend(std::move(model), training, forced_isa(options));
  });
}

std::string cache_machine(const RenderOptions& options) {
  return on_device(options, [&] {
    if (const std::optional<std::string> device = vulkan_device(options))
      return fmt::format("vulkan {}", neural::vulkan::device_name(*device));
    return std::string(simd::isa_name(simd::select_isa(forced_isa(options))));
  });
}

}  // namespace gatelight::renderer
