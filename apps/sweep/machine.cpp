#include "apps/sweep/machine.h"

#include <fmt/format.h>

#include <fstream>

#include "renderer/cache/cache_backend.h"
#include "renderer/machine/errors.h"
#include "renderer/surface/embree.h"

namespace gatelight::apps {

std::string cpu_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    if (line.rfind("model name", 0) != 0 || colon == std::string::npos) continue;
    const std::size_t begin = line.find_first_not_of(' ', colon + 1);
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return "unknown";
}

std::string machine_text(const renderer::RenderOptions& options) {
  static const std::string cpu = cpu_name();
  std::string kernels = "none";
  if (renderer::uses_cache(options.integrator)) {
    try {
      kernels = renderer::cache_machine(options);
    } catch (const renderer::Unavailable&) {
      // Its cells will say so.
    }
  }
  return fmt::format("cpu {}\nisa {}\nkernels {}", cpu,
                     options.isa == "auto" ? renderer::best_isa() : options.isa, kernels);
}

}  // namespace gatelight::apps
