#pragma once
// The files of page/ and Chart.js as one HTML text, with data inside.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace gatelight::apps {

/// JSON that may stand in a <script>: ASCII, and no '<', which could end the element.
std::string json_for_script(const nlohmann::ordered_json& json);

/// Puts each value in the place of {{its name}}. What a value holds is not looked through again.
struct Slot {
  std::string_view name;
  std::string_view value;
};
std::string fill_slots(std::string_view text, std::initializer_list<Slot> slots);

/// `pictures`: names of files in `results`, and their data URIs.
std::string make_page(const nlohmann::ordered_json& results, const nlohmann::ordered_json& pictures);

}  // namespace gatelight::apps
