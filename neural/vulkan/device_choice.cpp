#include "neural/vulkan/device_choice.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.h"
#include "base/to_number.h"

namespace gatelight::neural::vulkan {

namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string listing(std::span<const DeviceFacts> devices) {
  if (devices.empty()) return "no Vulkan device was found";
  std::string text = "devices are";
  for (std::size_t i = 0; i < devices.size(); ++i) {
    const std::string reason = refusal(devices[i]);
    text += fmt::format("{} {}: {} ({}{}{})", i == 0 ? "" : ";", i, devices[i].name,
                        kind_name(devices[i].kind), reason.empty() ? "" : ", refused: ", reason);
  }
  return text;
}

std::optional<std::size_t> best_of(std::span<const DeviceFacts> devices) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < devices.size(); ++i)
    if (refusal(devices[i]).empty() && (!best || devices[i].kind < devices[*best].kind)) best = i;
  return best;
}

std::size_t choose_best(std::span<const DeviceFacts> devices) {
  const std::optional<std::size_t> best = best_of(devices);
  if (!best) throw Unavailable("no Vulkan device can be used: " + listing(devices));
  return *best;
}

std::size_t choose_named(std::span<const DeviceFacts> devices, std::string_view wanted) {
  std::optional<std::size_t> refused;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (lower(devices[i].name).find(lower(wanted)) == std::string::npos) continue;
    if (refusal(devices[i]).empty()) return i;
    if (!refused) refused = i;
  }
  if (!refused) throw Unavailable(fmt::format("Vulkan device '{}': {}", wanted, listing(devices)));
  return *refused;
}

}  // namespace

std::string_view kind_name(DeviceKind kind) {
  constexpr std::string_view kNames[] = {"discrete", "integrated", "virtual", "software", "other"};
  return kNames[static_cast<std::size_t>(kind)];
}

std::string refusal(const DeviceFacts& d) {
  if (d.major < 1 || (d.major == 1 && d.minor < 2))
    return fmt::format("has Vulkan {}.{}, 1.2 is needed", d.major, d.minor);
  if (!d.compute_queue) return "has no compute queue";
  if (!d.buffer_addresses) return "lacks bufferDeviceAddress";
  if (d.workgroup_threads < kWorkgroupThreads)
    return fmt::format("has workgroups of {} threads, {} are needed", d.workgroup_threads, kWorkgroupThreads);
  if (d.shared_bytes < kMinSharedBytes)
    return fmt::format("has {} bytes of shared memory, {} are needed", d.shared_bytes, kMinSharedBytes);
  return "";
}

std::size_t choose_device(std::span<const DeviceFacts> devices, std::string_view wanted) {
  if (wanted.empty()) return choose_best(devices);
  const std::optional<std::size_t> index = to_number<std::size_t>(wanted);
  if (index && *index >= devices.size())
    throw Unavailable(fmt::format("Vulkan device {}: {}", *index, listing(devices)));
  const std::size_t chosen = index ? *index : choose_named(devices, wanted);
  const std::string reason = refusal(devices[chosen]);
  if (!reason.empty())
    throw Unavailable(fmt::format("Vulkan device {} ({}) {}", chosen, devices[chosen].name, reason));
  return chosen;
}

std::optional<std::size_t> choose_hardware(std::span<const DeviceFacts> devices) {
  const std::optional<std::size_t> best = best_of(devices);
  return best && devices[*best].kind < DeviceKind::software ? best : std::nullopt;
}

}  // namespace gatelight::neural::vulkan
