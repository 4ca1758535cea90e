#pragma once

#include <map>
#include <string>

#include "renderer/image/picture.h"

namespace gatelight::apps {

/// Warns of pictures with the same seed: their noise is the same, and a mean does not reduce it.
class SeedsSeen {
 public:
  void add(const renderer::Picture& picture, const std::string& file);

 private:
  std::map<std::string, std::string> files_by_seed_;
};

}  // namespace gatelight::apps
