#pragma once
// The bytes as a file, for code that wants a path.

#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "tests/fuzz/targets.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::fuzz {

/// One file in a folder of its own, both gone with the object.
class InputFile {
 public:
  explicit InputFile(const std::string& name) : path_(folder_ / name) {}

  const std::filesystem::path& path() const { return path_; }

  const std::filesystem::path& write(Bytes bytes) const {
    std::FILE* file = std::fopen(path_.c_str(), "wb");
    const bool written = file != nullptr && std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
    if (file == nullptr || std::fclose(file) != 0 || !written)
      throw std::runtime_error("cannot write " + path_.string());
    return path_;
  }

 private:
  tests::TemporaryFolder folder_;
  std::filesystem::path path_;
};

/// A refusal is one line, and says something.
inline void check_line(const std::string& message) {
  if (message.empty()) throw Violation("an error without a message");
  for (const char c : message) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) throw Violation("control characters in the message: " + message);
  }
}

/// Runs what may refuse the input with such an error.
template <class Refusal, class Act>
void read_or_refuse(const Act& act) {
  try {
    act();
  } catch (const Refusal& error) {
    check_line(error.what());
  }
}

}  // namespace gatelight::fuzz
