// --config: the file for render, and for the other subcommands where it has flags of theirs.

#include <string>
#include <string_view>
#include <vector>

#include "apps/command_line.h"
#include "apps/terminal/errors.h"
#include "tests/fuzz/input_file.h"

namespace gatelight::fuzz {

void config_file(Bytes bytes) {
  static const InputFile file("config.toml");
  const std::string path = file.write(bytes).string();
  const std::vector<std::vector<const char*>> calls = {
      {"gatelight", "render", "a.glb", "-o", "a.exr", "--config", path.c_str()},
      {"gatelight", "info", "--config", path.c_str()},
      {"gatelight", "sweep", "a.glb", "-o", "a", "--config", path.c_str()},
  };
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  for (const std::vector<const char*>& call : calls) {
    // Most of the time goes into making the flags of a subcommand.
    if (call != calls.front() && text.find(call[1]) == text.npos) continue;
    const int code = apps::read_only(static_cast<int>(call.size()), call.data());
    if (code != apps::kDone && code != apps::kUsage && code != apps::kInput)
      throw Violation("exit code " + std::to_string(code));
  }
}

}  // namespace gatelight::fuzz
