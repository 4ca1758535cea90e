#pragma once
// Allows one sweep at a time in a folder.

#include <string>

namespace gatelight::apps {

/// Holds the lock until it is destroyed or the program ends, however it ends.
class FolderLock {
 public:
  /// Throws InputError where another process has the lock, OutputError where FOLDER/.lock cannot be
  /// opened. On a file system without locks there is no protection.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_ = -1;
};

}  // namespace gatelight::apps
