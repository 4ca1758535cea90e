#include "apps/terminal/terminal.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <system_error>

#include "apps/terminal/text.h"
#include "base/file/atomic_file.h"

namespace gatelight::apps {
namespace {

std::atomic<bool> is_silent{false};

}  // namespace

void set_silent(bool silent) {
  is_silent = silent;
}

int terminal_columns() {
  winsize size{};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

void print_status(std::string_view text) {
  if (is_silent) return;
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
}

void print_json_line(const nlohmann::ordered_json& object) {
  print_status(json_text(object, -1) + "\n");
  std::fflush(stderr);
}

void write_stdout(std::string_view bytes) {
  if (is_silent) return;
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0) {
    throw OutputError("cannot write to stdout: " + std::generic_category().message(errno));
  }
}

void write_text(const std::string& target, const std::string& text) {
  if (target == "-") return write_stdout(text);
  write_file_atomically(target, text);
}

}  // namespace gatelight::apps
