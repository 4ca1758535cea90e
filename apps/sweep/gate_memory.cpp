#include "apps/sweep/gate_memory.h"

#include <nlohmann/json.hpp>

#include "apps/reports/json.h"
#include "base/file/atomic_file.h"
#include "renderer/render.h"

namespace gatelight::apps {

std::uint64_t gate_memory(const std::string& file, const std::string& key, const scene::Scene& scene,
                          const renderer::RenderOptions& options) {
  nlohmann::ordered_json known = read_json_file(file);
  if (!known.is_object()) known = nlohmann::ordered_json::object();
  if (known.contains(key) && known[key].is_number_unsigned()) return known[key].get<std::uint64_t>();
  const std::uint64_t nodes = renderer::Renderer(scene, options).set_up_cache().nodes;
  const bool fp32 = options.cache.training.precision == neural::FeaturePrecision::fp32;
  // Only the features: the network's weights are no part of --cache-memory.
  known[key] = nodes * options.cache.gate.features * (fp32 ? 4u : 2u);
  write_file_atomically(file, known.dump(1) + "\n");
  return known[key].get<std::uint64_t>();
}

}  // namespace gatelight::apps
