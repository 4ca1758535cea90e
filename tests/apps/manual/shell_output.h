#pragma once
// Commands of a shell, for tests with other programs.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

namespace gatelight::tests {

/// What the command writes to stdout.
inline std::string shell_output(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  std::array<char, 4096> part{};
  while (pipe && std::fgets(part.data(), part.size(), pipe.get()) != nullptr) text += part.data();
  return text;
}

inline bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " > /dev/null").c_str()) == 0;
}

}  // namespace gatelight::tests
