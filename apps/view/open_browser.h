#pragma once

#include <string>

namespace gatelight::apps {

/// Opens an address in the desktop's browser, where there are a desktop and `xdg-open`. Does not wait.
void open_browser(const std::string& address);

}  // namespace gatelight::apps
