#include "renderer/cache/device_trial.h"

#include <cstdint>
#include <utility>
#include <vector>

#include "base/clock.h"
#include "base/errors.h"
#include "base/parallel/team.h"
#include "base/random.h"
#include "neural/vulkan/devices.h"
#include "renderer/cache/cache_backend.h"
#include "renderer/cache/cache_model.h"

namespace gatelight::renderer {
namespace {

/// Of 2048 records each, they take some 5 ms on 16 cores.
constexpr std::size_t kTrialSteps = 8;

/// Records at random places of the layout.
struct MadeUpRecords {
  MadeUpRecords(const neural::Model& model, std::size_t count)
      : vectors(count, {0.0f, 0.0f, 1.0f}), numbers(count, 0.5f), targets(count * model.config.mlp.outputs) {
    const auto random = [](std::size_t i, std::uint64_t of) { return uniform_float(of, i); };
    std::vector<std::uint32_t> stored;
    for (std::uint32_t s = 0; s < model.gate.surfaces.size(); ++s)
      if (model.gate.levels[s * model.gate.stack].resolution > 0) stored.push_back(s);
    const neural::Float3& low = model.config.hash_grid.bounds_min;
    const neural::Float3& high = model.config.hash_grid.bounds_max;
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t o = 0; o < model.config.mlp.outputs; ++o)
        targets[i * model.config.mlp.outputs + o] = random(i, o);
      neural::Float3& position = positions.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis)
        position[axis] = low[axis] + random(i, 10 + axis) * (high[axis] - low[axis]);
      if (stored.empty()) continue;
      const auto below = [&](std::size_t n, std::uint64_t of) {
        return static_cast<std::uint32_t>(random(i, of) * static_cast<float>(n)) %
               static_cast<std::uint32_t>(n);
      };
      surfaces.push_back(stored[below(stored.size(), 20)]);
      triangles.push_back(below(model.gate.surfaces[surfaces.back()].triangle_count, 21));
      barycentrics.push_back({0.5f * random(i, 22), 0.5f * random(i, 23)});
    }
  }
  neural::TrainingBatch batch() const {
    return {
        {surfaces, triangles, barycentrics, positions, vectors, vectors, vectors, numbers, numbers.size()},
        targets};
  }

  std::vector<std::uint32_t> surfaces, triangles;
  std::vector<neural::Float2> barycentrics;
  std::vector<neural::Float3> positions, vectors;
  std::vector<float> numbers, targets;
};

/// Of a step. The first one, which compiles shaders and allocates, does not count.
double step_seconds(neural::Backend& backend, const neural::TrainingBatch& batch) {
  double seconds = 0.0;
  Team::run([&](Team& team) {
    const auto make = [&](std::size_t steps) {
      backend.start(std::vector(steps, batch), &team);
      for (std::size_t i = 0; i < steps; ++i) backend.finish();
    };
    make(1);
    const Clock::time_point start = Clock::now();
    make(kTrialSteps);
    seconds = seconds_since(start) / kTrialSteps;
  });
  return seconds;
}

}  // namespace

bool device_is_faster(const DeviceTrial& trial) {
  return trial.device_seconds < 0.75 * trial.cpu_seconds;
}

std::unique_ptr<neural::Backend> choose_cache_backend(std::shared_ptr<const neural::Model> model,
                                                      const RenderOptions& options,
                                                      std::optional<DeviceTrial>& trial) {
  RenderOptions with = options;
  with.cache.device = "cpu";
  std::unique_ptr<neural::Backend> cpu = make_cache_backend(model, with);
  const std::string device = neural::vulkan::hardware_device();
  if (device.empty()) return cpu;
  const neural::ModelState start = neural::initial_state(*model, training_options(options));
  const MadeUpRecords records(*model, static_cast<std::size_t>(options.cache.batch));
  DeviceTrial made{device, step_seconds(*cpu, records.batch()), 0.0};
  cpu->import_state(start);
  if (made.cpu_seconds * options.cache.train_steps.value_or(0) < kDeviceStartSeconds) return cpu;
  try {
    with.cache.device = "vulkan:" + device;
    std::unique_ptr<neural::Backend> other = make_cache_backend(std::move(model), with);
    made.device_seconds = step_seconds(*other, records.batch());
    other->import_state(start);
    trial = made;
    if (device_is_faster(made)) return other;
  } catch (const Unavailable&) {  // such a device, or one that is lost, is not chosen
  } catch (const BadConfiguration&) {
  } catch (const OutOfDeviceMemory&) {
  }
  return cpu;
}

}  // namespace gatelight::renderer
