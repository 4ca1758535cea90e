#pragma once
// The flags of `compare`.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/settings/frame_range.h"
#include "renderer/metrics/flip.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {

enum class Map : std::uint8_t { flip, hdr_flip, relative };
inline constexpr renderer::Choice<Map> kMaps[] = {
    {"flip", Map::flip}, {"hdr_flip", Map::hdr_flip}, {"relative", Map::relative}};

struct CompareSettings {
  std::string reference;  ///< with `frames`, the name has a place for their number; so has `test`
  std::string test;
  std::vector<std::string> halves;  ///< empty, or the second reference and the second test
  std::optional<FrameList> frames;  ///< empty: two pictures
  std::string metrics;
  std::string json;
  std::string error_map;
  Map map = Map::flip;
  renderer::FlipOptions flip;

  bool has_pairs_of_frames() const { return frames && !frames->is_single(); }
};

}  // namespace gatelight::apps
