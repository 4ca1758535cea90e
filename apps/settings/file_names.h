#pragma once
// Which flag names which file: what is written must not be read, or written twice.

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

namespace gatelight::apps {

/// Files are told apart by where they will lie, not by how they are called: folders may be links, and so may
/// the files themselves. Empty names and "-" are no files.
class FileNames {
 public:
  void read(std::string_view flag, const std::string& name);
  /// Throws UsageError where another flag, or the same one, has named the file; but not for `may_replace`.
  void write(std::string_view flag, const std::string& name, std::string_view may_replace = "");

 private:
  std::map<std::filesystem::path, std::string> flags_;
};

}  // namespace gatelight::apps
