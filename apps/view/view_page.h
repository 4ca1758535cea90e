#pragma once
// The files of the page, which are a part of the program.

#include <string>
#include <string_view>

namespace gatelight::apps {

struct PageFile {
  std::string_view type;  ///< as HTTP names it
  std::string_view text;
};

/// The file of this name; "" is the page itself. Null for another name.
const PageFile* page_file(const std::string& name);

}  // namespace gatelight::apps
