#include "apps/terminal/results.h"

#include <cerrno>
#include <cstdio>
#include <system_error>

#include "renderer/machine/atomic_file.h"

namespace gatelight::apps {

void write_text(const std::string& target, const std::string& text) {
  if (target != "-") {
    renderer::write_file_atomically(target, text);
    return;
  }
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0) {
    throw renderer::OutputError("cannot write to stdout: " + std::generic_category().message(errno));
  }
}

}  // namespace gatelight::apps
