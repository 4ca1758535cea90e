#pragma once
// How many bytes the features of a cache take on a scene, for another encoding to take as many.

#include <cstdint>
#include <map>
#include <string>

#include "renderer/settings/options.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// Remembers in a file: finding out builds the scene's acceleration structure and scouts.
class GateMemoryStore {
 public:
  explicit GateMemoryStore(std::string file);

  bool knows(const std::string& key) const { return known_.contains(key); }
  /// key: of scene and options. Throws what renderer::Renderer throws, and OutputError.
  std::uint64_t bytes(const std::string& key, const scene::Scene& scene,
                      const renderer::RenderOptions& options);

 private:
  std::string file_;
  std::map<std::string, std::uint64_t> known_;
};

}  // namespace gatelight::apps
