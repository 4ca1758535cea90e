#pragma once
// The files of page/ and Chart.js as one HTML text, with the data inside.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace gatelight::apps {

/// JSON for a <script> element: ASCII without '<', which could end the element.
std::string json_for_script(const nlohmann::ordered_json& json);

/// Replaces each {{name}} by the value of its slot. Values are not searched for slots again.
struct Slot {
  std::string_view name;
  std::string_view value;
};
std::string fill_slots(std::string_view text, std::initializer_list<Slot> slots);

struct PagePicture {
  nlohmann::ordered_json entry;  ///< entry of the index that the script reads: {"file", ...}
  std::string uri;
};

/// The pictures are separate from their index, so that only pictures that are shown are decoded.
std::string make_page(const nlohmann::ordered_json& results, const std::vector<PagePicture>& pictures);

}  // namespace gatelight::apps
