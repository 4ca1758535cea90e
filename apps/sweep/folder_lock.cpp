#include "apps/sweep/folder_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "apps/terminal/errors.h"
#include "base/file/atomic_file.h"

namespace gatelight::apps {

FolderLock::FolderLock(const std::string& folder) {
  const std::string file = (std::filesystem::path(folder) / ".lock").string();
  descriptor_ = ::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    throw OutputError(fmt::format("cannot write '{}': {}", file, std::generic_category().message(errno)));
  }
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
  ::close(descriptor_);
  throw InputError(fmt::format("'{}': another sweep is at work here, expected one at a time", folder));
}

FolderLock::~FolderLock() {
  ::close(descriptor_);
}

}  // namespace gatelight::apps
