#pragma once

#include <map>
#include <string>

#include "renderer/image/picture.h"

namespace gatelight::apps {

/// Warns of pictures with one seed: they have the same noise, which no mean makes less.
class SeedsSeen {
 public:
  void add(const renderer::Picture& picture, const std::string& file);

 private:
  std::map<std::string, std::string> files_by_seed_;
};

}  // namespace gatelight::apps
