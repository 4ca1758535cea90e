#include "apps/terminal/terminal.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>
#include <nlohmann/json.hpp>

namespace gatelight::apps {

int terminal_columns() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

void tell(std::string_view text) {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
}

void print_json_line(const nlohmann::ordered_json& object) {
  tell(fmt::format("{}\n", object.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)));
  std::fflush(stderr);
}

}  // namespace gatelight::apps
