#pragma once
// Records which flag names which file: a file must not be read and written, or written twice.

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Files are compared by their location after following links, not by name. Empty names and those of standard
/// output are no files.
class FileNames {
 public:
  void read(std::string_view option, const std::string& name);
  /// Throws BadOption where a flag other than `may_replace` has already named the file.
  void write(std::string_view option, const std::string& name, std::string_view may_replace = "");

 private:
  std::map<std::filesystem::path, std::string> flags_;
};

/// The files that are read, each with its flag. Callers add the files that they write.
FileNames read_files(const RenderSettings& settings);

/// Throws BadOption where a picture of a run would write a file that is read, or that is written already.
void check_file_names(std::span<const RenderSettings> pictures);

}  // namespace gatelight::apps
