#pragma once
// A tiny scene with the cache of its files, and files whose digest is corrected after a mutation.

#include <memory>
#include <vector>

#include "renderer/cache/cache_state.h"
#include "renderer/driver/checkpoint.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"
#include "tests/fuzz/targets.h"

namespace gatelight::fuzz {

/// Two squares, one of them double-sided, and the smallest cache that there can be on them.
struct MadeCache {
  MadeCache();
  ~MadeCache();

  std::shared_ptr<const neural::Model> model(const renderer::CacheSetup& setup) const;
  /// A state of the cache, and the setup that it was made with.
  renderer::CacheState state() const;
  neural::TrainingOptions training() const;
  /// Imports the state and queries it.
  void use(std::shared_ptr<const neural::Model> model, const renderer::CacheState& state) const;

  renderer::RenderOptions options;
  std::size_t instances = 0;

 private:
  struct Built;
  std::unique_ptr<Built> built_;
};

const MadeCache& made_cache();

inline const renderer::SceneFingerprint kFingerprint = {
    {"geometry", "a1"}, {"attributes", "b2"}, {"materials", "c3"}, {"lights", "d4"}, {"environment", "e5"}};

renderer::CheckpointIdentity made_identity();
/// A film of 2x2 pixels, without samples.
renderer::Film made_film();

/// The file with the digest of its content; unchanged if it is not such a file.
std::vector<std::uint8_t> with_right_digest(Bytes file);

}  // namespace gatelight::fuzz
