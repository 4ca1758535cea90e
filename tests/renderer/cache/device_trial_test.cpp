// The choice between the CPU and a graphics device.

#include "renderer/cache/device_trial.h"

#include <gtest/gtest.h>

#include "neural/vulkan/devices.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/cache/cache_model.h"

namespace gatelight::renderer {
namespace {

TEST(DeviceTrial, ADeviceIsTakenOnlyIfItIsFasterByAQuarter) {
  EXPECT_TRUE(device_is_faster({"", 1.0, 0.74}));
  EXPECT_FALSE(device_is_faster({"", 1.0, 0.76}));
  EXPECT_FALSE(device_is_faster({"", 1.0, 1.0}));
  EXPECT_FALSE(device_is_faster({"", 0.0, 0.0}));
}

TEST(DeviceTrial, WithoutHardwareTheCpuStaysAsItWas) {
  if (!neural::vulkan::hardware_device().empty()) GTEST_SKIP() << "there is a device";
  neural::ModelConfig config;
  config.encoding = neural::FeatureEncoding::hash_grid;
  const std::shared_ptr<const neural::Model> model = neural::make_model(config);
  RenderOptions options;
  options.cache.train_steps = 1 << 20;
  std::optional<DeviceTrial> trial;
  const auto chosen = choose_cache_backend(model, options, trial);
  EXPECT_FALSE(trial);
  EXPECT_EQ(chosen->name(), make_cache_backend(model, options)->name());
  EXPECT_EQ(chosen->export_state(), neural::initial_state(*model, training_options(options)));
}

}  // namespace
}  // namespace gatelight::renderer
