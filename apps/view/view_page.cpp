#include "apps/view/view_page.h"

#include <map>

#include "gatelight_view_page.inc"

namespace gatelight::apps {

const PageFile* page_file(const std::string& name) {
  static const std::map<std::string, PageFile> files = {
      {"", {"text/html; charset=utf-8", kViewHtml}},
      {"view.css", {"text/css; charset=utf-8", kViewStyle}},
      {"view.js", {"text/javascript; charset=utf-8", kViewScript}},
  };
  const auto found = files.find(name);
  return found == files.end() ? nullptr : &found->second;
}

}  // namespace gatelight::apps
