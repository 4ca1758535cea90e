#pragma once
// A trained cache in a file of its own (`cache-out`, `cache-in`): for another camera of the same scene.
// renderer/driver/README.md lists what must be equal.

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "neural/model/model_file.h"
#include "renderer/cache/cache_state.h"
#include "renderer/fingerprint/scene_fingerprint.h"
#include "renderer/settings/options.h"

namespace gatelight::renderer {

/// The options that decide the meaning of a cache's answers. The model's metadata describe network and
/// layout.
struct CacheMeaning {
  const RenderOptions& options;
  float ao_distance = 0.0f;  ///< metres, resolved
};

/// What a file has beside the cache: a frame's part (temporal/frame_file.h).
struct OtherContent {
  std::vector<TensorView> tensors;
  Metadata metadata;
};

/// Writes the file atomically and fsyncs it. Throws OutputError, CacheFileError, and
/// BadConfiguration for a state that is not the model's.
void write_cache_file(const std::filesystem::path& path, const CacheState& state, const neural::Model& model,
                      const neural::TrainingOptions& options, const CacheMeaning& meaning,
                      const SceneFingerprint& scene, const OtherContent& other = {});

/// A file that is read in two stages, because the model is built from its setup. Its content is untrusted:
/// all members throw CacheFileError, which names the file, the value and what was expected.
class CacheFile {
 public:
  explicit CacheFile(const std::filesystem::path& path);

  const CacheSetup& setup() const { return setup_; }
  /// Throws, naming every difference, for a cache with another meaning, of another scene, or of another
  /// number of instances. For nao lights and the environment may differ.
  void expect(const CacheMeaning& meaning, const SceneFingerprint& scene, std::size_t instances) const;
  /// Throws where the tensors are not of this model. Call it before memory for them is allocated.
  void expect_model(const neural::Model& model, const neural::TrainingOptions& options) const;
  /// `others`: the names of tensors that the file may have beside the cache.
  CacheState read_state(const neural::Model& model, const neural::TrainingOptions& options,
                        std::set<std::string> others = {});

 private:
  SafetensorsReader file_;
  CacheSetup setup_;
};

}  // namespace gatelight::renderer
