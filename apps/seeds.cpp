#include "apps/seeds.h"

#include <fmt/format.h>

#include "apps/terminal/log.h"

namespace gatelight::apps {

void SeedsSeen::add(const renderer::Picture& picture, const std::string& file) {
  const auto seed = picture.metadata.find("seed");
  if (seed == picture.metadata.end()) return;
  const auto [first, is_new] = files_by_seed_.emplace(seed->second, file);
  if (is_new) return;
  log_warning(fmt::format("'{}' and '{}' have the same seed {}: their noise is not independent",
                          first->second, file, seed->second));
}

}  // namespace gatelight::apps
