#pragma once
// A tiny scene with the cache that files of it hold, and files whose digest is made right after a mutation.

#include <memory>
#include <string>
#include <vector>

#include "renderer/cache/cache_state.h"
#include "renderer/run/checkpoint.h"
#include "renderer/settings/options.h"
#include "renderer/transport/world.h"
#include "tests/fuzz/targets.h"

namespace gatelight::fuzz {

/// Two squares, one of them double-sided, and the smallest cache that there can be on them.
struct MadeCache {
  MadeCache();
  ~MadeCache();

  std::shared_ptr<const neural::Model> model(const renderer::CacheSetup& setup) const;
  /// Any state of the cache, and the setup that it was made with.
  renderer::CacheState state() const;
  neural::TrainingOptions training() const;
  /// Takes the state in, and asks it something.
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
/// Of 2x2 pixels, without samples.
renderer::Film made_film();

/// The file with the digest that its content asks for; as it is where it is no such file.
std::vector<std::uint8_t> with_right_digest(Bytes file);

}  // namespace gatelight::fuzz
