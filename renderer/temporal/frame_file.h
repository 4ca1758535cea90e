#pragma once
// What one frame of an animation hands on to the next, in a file: a cache file with the frame's light, or the
// light alone where there is no cache.

#include <filesystem>
#include <optional>
#include <vector>

#include "renderer/cache/cache_file.h"
#include "renderer/render.h"

namespace gatelight::renderer {

/// The light of a frame: see History.
struct FrameLight {
  int width = 0;
  int height = 0;
  std::vector<float> color, samples;

  bool empty() const { return color.empty(); }
};

/// Views into the light, which must outlive it.
OtherContent frame_content(const FrameStatus& status, const FrameLight& light);

/// Writes a file without a cache. Throws OutputError.
void write_frame_file(const std::filesystem::path& path, const FrameStatus& status, const FrameLight& light,
                      const SceneFingerprint& scene);

/// The names of the tensors of frame_content().
std::set<std::string> frame_tensors();

/// A file of either kind. All members throw CacheFileError.
class FrameFile {
 public:
  explicit FrameFile(const std::filesystem::path& path);

  const FrameStatus& status() const { return status_; }
  /// Throws for another scene or another size.
  FrameLight read_light(const SceneFingerprint& scene, int width, int height);

 private:
  SafetensorsReader file_;
  FrameStatus status_;
};

}  // namespace gatelight::renderer
