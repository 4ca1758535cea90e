#include "neural/vulkan/instance.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/errors.h"

namespace gatelight::neural::vulkan {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr std::uint32_t kNoFamily = ~0u;

/// The callback of the validation layer. Its types are those of C or of C++, by the version of the headers.
constexpr auto take_message = [](auto, auto, const auto* data, void* messages) -> VkBool32 {
  std::string message = data->pMessage;
  std::replace(message.begin(), message.end(), '\n', ' ');  // errors have one line
  static_cast<ValidationMessages*>(messages)->add(std::move(message));
  return VK_FALSE;
};

vk::DebugUtilsMessengerCreateInfoEXT messenger_info(ValidationMessages* messages) {
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  vk::DebugUtilsMessengerCreateInfoEXT info;
  info.messageSeverity = Severity::eWarning | Severity::eError;
  info.messageType = Type::eValidation | Type::ePerformance;
  info.pfnUserCallback = take_message;
  info.pUserData = messages;
  return info;
}

vk::raii::Context open_loader() {
  try {
    return {};
  } catch (const std::runtime_error&) {
    throw Unavailable("there is no Vulkan loader (libvulkan.so.1) on this machine");
  }
}

vk::raii::Instance make_instance(const vk::raii::Context& context, bool validate,
                                 ValidationMessages* messages) {
  const vk::ApplicationInfo application("gatelight", 1, nullptr, 0, VK_API_VERSION_1_2);
  vk::InstanceCreateInfo info({}, &application);
  const vk::DebugUtilsMessengerCreateInfoEXT messenger = messenger_info(messages);
  const char* const extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  // The layer's synchronization checks find hazards of memory and ordering.
  const vk::ValidationFeatureEnableEXT synchronization =
      vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  vk::ValidationFeaturesEXT features(1, &synchronization, 0, nullptr, &messenger);
  if (validate) {
    info.setPEnabledLayerNames(kValidationLayer).setPEnabledExtensionNames(extension);
    info.pNext = &features;
  }
  try {
    return {context, info};
  } catch (const vk::LayerNotPresentError&) {
    throw Unavailable(
        fmt::format("the layer {} is missing: install vulkan-validationlayers", kValidationLayer));
  } catch (const vk::SystemError& error) {
    throw Unavailable(fmt::format("Vulkan cannot be started: {}",
                                  vk::to_string(static_cast<vk::Result>(error.code().value()))));
  }
}

DeviceKind kind_of(vk::PhysicalDeviceType type) {
  using enum DeviceKind;
  constexpr DeviceKind kKinds[] = {other, integrated, discrete, virtual_gpu, software};  // Vulkan's order
  const auto number = static_cast<std::size_t>(type);
  return number < std::size(kKinds) ? kKinds[number] : other;
}

}  // namespace

Instance::Instance(bool validate, std::shared_ptr<ValidationMessages> messages)
    : messages_(messages != nullptr ? std::move(messages) : std::make_shared<ValidationMessages>()),
      context_(open_loader()),
      instance_(make_instance(context_, validate, messages_.get())),
      messenger_(nullptr) {
  if (validate) messenger_ = vk::raii::DebugUtilsMessengerEXT(instance_, messenger_info(messages_.get()));
}

std::vector<vk::raii::PhysicalDevice> Instance::devices() const {
  try {
    std::vector<vk::raii::PhysicalDevice> found;
    for (vk::raii::PhysicalDevice& device : vk::raii::PhysicalDevices(instance_))
      found.push_back(std::move(device));
    return found;
  } catch (const vk::InitializationFailedError&) {
    return {};  // the loader found no working driver
  }
}

void Instance::check_messages() {
  const std::vector<std::string> messages = messages_->take();
  if (!messages.empty()) throw ValidationFailed("Vulkan validation: " + messages.front());
}

DeviceFacts facts_of(const vk::raii::PhysicalDevice& device) {
  const vk::PhysicalDeviceProperties properties = device.getProperties();
  DeviceFacts facts;
  facts.name = properties.deviceName.data();
  facts.kind = kind_of(properties.deviceType);
  facts.major = VK_API_VERSION_MAJOR(properties.apiVersion);
  facts.minor = VK_API_VERSION_MINOR(properties.apiVersion);
  facts.compute_queue = compute_family(device) != kNoFamily;
  facts.workgroup_threads = std::min(properties.limits.maxComputeWorkGroupInvocations,
                                     properties.limits.maxComputeWorkGroupSize[0]);
  facts.shared_bytes = properties.limits.maxComputeSharedMemorySize;
  if (properties.apiVersion >= VK_API_VERSION_1_2)
    facts.buffer_addresses =
        device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>()
            .get<vk::PhysicalDeviceVulkan12Features>()
            .bufferDeviceAddress == VK_TRUE;
  return facts;
}

std::uint32_t compute_family(const vk::raii::PhysicalDevice& device) {
  const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
  std::uint32_t found = kNoFamily;
  for (std::uint32_t i = 0; i < families.size(); ++i) {
    if (!(families[i].queueFlags & vk::QueueFlagBits::eCompute)) continue;
    if (!(families[i].queueFlags & vk::QueueFlagBits::eGraphics)) return i;
    if (found == kNoFamily) found = i;
  }
  return found;
}

}  // namespace gatelight::neural::vulkan
