#include "apps/sweep/page.h"

#include <algorithm>
#include <cassert>

// kPageHtml, kPageStyle, kPageScript and kChartScript, which is empty in a build without Chart.js: string
// literals (cmake/EmbedTexts.cmake).
#include "gatelight_page.inc"

namespace gatelight::apps {
namespace {

using nlohmann::ordered_json;

template <std::size_t size>
constexpr std::string_view view(const char (&literal)[size]) {
  return {literal, size - 1};
}

/// The ID of the element that holds a picture.
std::string element_id(std::size_t index) {
  return "picture-" + std::to_string(index);
}

ordered_json make_index(const std::vector<PagePicture>& pictures) {
  ordered_json index = ordered_json::array();
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    ordered_json entry = pictures[i].entry;
    entry["bytes"] = pictures[i].uri.size();
    entry["element"] = element_id(i);
    index.push_back(std::move(entry));
  }
  return index;
}

std::string picture_elements(const std::vector<PagePicture>& pictures) {
  std::string text;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    text += "<script type=\"text/plain\" id=\"" + element_id(i) + "\">" + pictures[i].uri + "</script>\n";
  }
  return text;
}

}  // namespace

std::string json_for_script(const ordered_json& json) {
  const std::string dumped = json.dump(-1, ' ', true, ordered_json::error_handler_t::replace);
  std::string text;
  text.reserve(dumped.size());
  for (const char c : dumped) {
    // '<' occurs only in strings, where JSON allows this escape.
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
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

std::string make_page(const ordered_json& results, const std::vector<PagePicture>& pictures) {
  const std::string results_text = json_for_script(results);
  const std::string index_text = json_for_script(make_index(pictures));
  const std::string pictures_text = picture_elements(pictures);
  std::size_t bytes = 0;
  for (const std::string_view part :
       {view(kPageHtml), view(kPageStyle), view(kChartScript), view(kPageScript),
        std::string_view(results_text), std::string_view(index_text), std::string_view(pictures_text)}) {
    bytes += part.size();
  }
  const std::string bytes_text = std::to_string(bytes);
  return fill_slots(view(kPageHtml), {{"bytes", bytes_text},
                                      {"style", view(kPageStyle)},
                                      {"chart", view(kChartScript)},
                                      {"results", results_text},
                                      {"index", index_text},
                                      {"pictures", pictures_text},
                                      {"script", view(kPageScript)}});
}

}  // namespace gatelight::apps
