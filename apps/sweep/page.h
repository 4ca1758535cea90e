#pragma once
// The files of page/ and Chart.js as one HTML text, with data inside.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace gatelight::apps {

/// JSON that may stand in a <script>: ASCII, and no '<', which could end the element.
std::string json_for_script(const nlohmann::ordered_json& json);

/// Puts each value in the place of {{its name}}. What a value holds is not looked through again.
struct Slot {
  std::string_view name;
  std::string_view value;
};
std::string fill_slots(std::string_view text, std::initializer_list<Slot> slots);

struct PagePicture {
  nlohmann::ordered_json entry;  ///< of the index that the script reads: {"file", ...}
  std::string uri;
};

/// The pictures stand beside their index, so that nobody reads more of them than are looked at.
std::string make_page(const nlohmann::ordered_json& results, const std::vector<PagePicture>& pictures);

}  // namespace gatelight::apps
