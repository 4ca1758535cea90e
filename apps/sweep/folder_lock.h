#pragma once
// One sweep at a time in a folder.

#include <string>

namespace gatelight::apps {

/// Until it goes away, or the program does, however it ends.
class FolderLock {
 public:
  /// Throws InputError where another has it, renderer::OutputError where FOLDER/.lock cannot be opened. A
  /// file system without locks gives none.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace gatelight::apps
