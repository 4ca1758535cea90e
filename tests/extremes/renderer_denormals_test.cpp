// Denormal floats in the renderer: its threads flush them, whatever the caller does.

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>

#include "base/platform/flush_denormals.h"
#include "renderer/render.h"
#include "tests/support/room.h"

namespace gatelight::renderer {
namespace {

using testing::room;

TEST(RendererDenormals, EveryThreadFlushesAndTheCallersControlWordIsKept) {
  const scene::Scene s = room();
  std::size_t most = 0;
  std::vector<std::vector<float>> pictures;
  const auto render = [&](bool flushing, Integrator integrator, int spp) {
    RenderOptions options = testing::small_picture();
    options.integrator = integrator;
    options.threads = 4;
    options.spp = spp;
    const std::uint64_t before = float_control();
    set_float_control(flushing ? before | kFlushBits : before & ~kFlushBits);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    std::atomic<int> without{0};
    Renderer renderer(s, options);
    // Called by the thread that has finished a tile.
    const Picture picture = renderer.render({.stop = [&] {
      if ((float_control() & kFlushBits) != kFlushBits) ++without;
      const std::lock_guard lock(mutex);
      threads.insert(std::this_thread::get_id());
      return false;
    }});
    EXPECT_EQ(float_control() & kFlushBits, flushing ? kFlushBits : std::uint64_t{0});
    set_float_control(before);
    EXPECT_EQ(without, 0);
    most = std::max(most, threads.size());
    return picture.layers[0].values;
  };
  for (const bool flushing : {false, true})
    for (const Integrator integrator : {Integrator::path, Integrator::ao})
      pictures.push_back(render(flushing, integrator, 8));
  // On a busy machine one thread may have done all of so small a picture before another woke up.
  for (int spp = 16; spp <= 1 << 15 && most < 2; spp *= 2) render(false, Integrator::path, spp);
  EXPECT_EQ(pictures[0], pictures[2]);
  EXPECT_EQ(pictures[1], pictures[3]);
  EXPECT_GE(most, 2u);
}

}  // namespace
}  // namespace gatelight::renderer
