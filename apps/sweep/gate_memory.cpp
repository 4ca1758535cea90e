#include "apps/sweep/gate_memory.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "apps/reports/json.h"
#include "base/file/atomic_file.h"
#include "renderer/render.h"

namespace gatelight::apps {

GateMemoryStore::GateMemoryStore(std::string file) : file_(std::move(file)) {
  const nlohmann::ordered_json json = read_json_file(file_);
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    if (value.is_number_unsigned()) known_[key] = value.get<std::uint64_t>();
  }
}

std::uint64_t GateMemoryStore::bytes(const std::string& key, const scene::Scene& scene,
                                     const renderer::RenderOptions& options) {
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  const std::uint64_t nodes = renderer::Renderer(scene, options).set_up_cache().nodes;
  const bool fp32 = options.cache.training.precision == neural::FeaturePrecision::fp32;
  // Only the features: the network's weights are no part of --cache-memory.
  const std::uint64_t bytes = nodes * options.cache.gate.features * (fp32 ? 4u : 2u);
  known_[key] = bytes;
  write_file_atomically(file_, nlohmann::json(known_).dump(1) + "\n");
  return bytes;
}

}  // namespace gatelight::apps
