#pragma once
// The bytes of the features of a cache on a scene, so that another encoding can take as many.

#include <cstdint>
#include <map>
#include <string>

#include "renderer/settings/options.h"
#include "scene/scene.h"

namespace gatelight::apps {

/// Stores them in a file, because computing them builds the scene's acceleration structure and scouts.
class GateMemoryStore {
 public:
  explicit GateMemoryStore(std::string file);

  bool knows(const std::string& key) const { return known_.contains(key); }
  /// Bytes for scene and options, whose key is `key`. Throws what renderer::Renderer throws, and OutputError.
  std::uint64_t bytes(const std::string& key, const scene::Scene& scene,
                      const renderer::RenderOptions& options);

 private:
  std::string file_;
  std::map<std::string, std::uint64_t> known_;
};

}  // namespace gatelight::apps
