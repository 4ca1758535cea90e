#include "apps/sweep/page.h"

#include <algorithm>
#include <cassert>
#include <nlohmann/json.hpp>

// kPageHtml, kPageStyle, kPageScript and kChartScript: string literals (cmake/EmbedTexts.cmake).
#include "gatelight_page.inc"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

template <std::size_t size>
constexpr std::string_view view(const char (&literal)[size]) {
  return {literal, size - 1};
}

}  // namespace

std::string json_for_script(const ordered_json& json) {
  const std::string text = json.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  // '<' is in strings only, where JSON may spell it so.
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string fill_slots(std::string_view text, std::initializer_list<Slot> slots) {
  constexpr std::string_view kOpen = "{{";
  constexpr std::string_view kClose = "}}";
  std::string filled;
  while (true) {
    const std::size_t open = text.find(kOpen);
    filled += text.substr(0, open);
    if (open == std::string_view::npos) return filled;
    text.remove_prefix(open + kOpen.size());
    const std::size_t close = text.find(kClose);
    assert(close != std::string_view::npos);
    const std::string_view name = text.substr(0, close);
    const auto slot = std::find_if(slots.begin(), slots.end(), [&](const Slot& s) { return s.name == name; });
    assert(slot != slots.end());
    filled += slot->value;
    text.remove_prefix(close + kClose.size());
  }
}

std::string make_page(const ordered_json& results, const ordered_json& pictures) {
  const std::string results_text = json_for_script(results);
  const std::string pictures_text = json_for_script(pictures);
  return fill_slots(view(kPageHtml), {{"style", view(kPageStyle)},
                                      {"chart", view(kChartScript)},
                                      {"results", results_text},
                                      {"pictures", pictures_text},
                                      {"script", view(kPageScript)}});
}

}  // namespace gatelight::apps
