#include "apps/settings/common_flags.h"

namespace gatelight::apps {

const std::set<std::string>& common_flags() {
  static const std::set<std::string> flags = {
      // Output and files
      "output", "exposure", "tonemap", "stats", "progress", "quiet", "checkpoint", "resume", "cache-in",
      "cache-out", "json", "command",
      // Picture
      "size", "spp", "time-limit", "max-error", "seed", "denoiser", "aov",
      // Scene and view
      "camera", "eye", "target", "fov", "environment", "environment-scale", "background", "variant",
      // Light transport
      "integrator", "preset", "max-depth", "clamp",
      // Cache and machine
      "train-steps", "threads", "memory-limit"};
  return flags;
}

}  // namespace gatelight::apps
