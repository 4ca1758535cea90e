// gatelight-render-again SCENE N [small]: renders a scene again and again in one process, and prints its
// memory. Exit code 1 if it grows. For scripts/check/leaks.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include "renderer/render.h"
#include "scene/gltf.h"

namespace {

using namespace gatelight;

double resident_mebibytes() {
  std::ifstream file("/proc/self/status");
  for (std::string word; file >> word;) {
    double kibibytes = 0.0;
    if (word == "VmRSS:" && file >> kibibytes) return kibibytes / 1024.0;
  }
  return 0.0;
}

void render(const std::string& file, renderer::Integrator integrator, bool small) {
  const scene::Scene scene = scene::load_gltf(file, {});
  renderer::RenderOptions options;
  options.integrator = integrator;
  options.width = small ? 16 : 160;
  options.height = small ? 16 : 90;
  options.spp = 2;
  options.cache.train_steps = small ? 2 : 16;
  options.cache.batch = small ? 64 : 1024;
  renderer::Renderer(scene, options).render();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const int repetitions = std::atoi(argv[2]);
  const bool small = argc > 3;
  std::vector<double> memory;
  for (int i = 0; i < repetitions; ++i) {
    for (const auto integrator : {renderer::Integrator::path, renderer::Integrator::ao,
                                  renderer::Integrator::nrc, renderer::Integrator::nao})
      render(argv[1], integrator, small);
    memory.push_back(resident_mebibytes());
    fmt::print("{:.1f}{}", memory.back(), i + 1 == repetitions ? " MiB\n" : " ");
    std::fflush(stdout);
  }
  if (repetitions < 20) return 0;
  // The allocator keeps pieces for a while. Compares the least of the second quarter with that of the last.
  const auto quarter = repetitions / 4;
  const double before = *std::min_element(memory.begin() + quarter, memory.begin() + 2 * quarter);
  const double after = *std::min_element(memory.end() - quarter, memory.end());
  fmt::print("memory {:.1f} MiB, then {:.1f} MiB ({:+.2f} %)\n", before, after,
             100.0 * (after / before - 1.0));
  return after <= 1.01 * before ? 0 : 1;
}
