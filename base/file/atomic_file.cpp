#include "base/file/atomic_file.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

namespace gatelight {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, const std::string& reason) {
  throw OutputError(fmt::format("cannot write '{}': {}", path.string(), reason));
}

std::string describe(int error) {
  return std::generic_category().message(error);
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

std::string link_of(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

/// Opens a file without a name, so that a killed program leaves nothing behind. Returns -1 where the file
/// system does not support it.
int open_nameless([[maybe_unused]] const fs::path& folder) {
#if defined(O_TMPFILE)
  const int descriptor = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0666);
  if (descriptor < 0 || ::access(link_of(descriptor).c_str(), F_OK) == 0) return descriptor;
  ::close(descriptor);
#endif
  return -1;
}

/// A rename is on the disk only when its folder is. Errors are ignored, because some file systems refuse.
void sync_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

}  // namespace

fs::path replaced_file(fs::path path) {
  constexpr int kMaxLinks = 40;  // as many as Linux follows
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i) {
    const fs::path there = fs::read_symlink(path, error);
    if (error) break;
    path = path.parent_path() / there;  // an absolute `there` replaces the folder
  }
  return path;
}

void check_writable(const fs::path& path) {
  if (path.empty()) refuse(path, "the name is empty");
  const fs::path target = replaced_file(path);
  const fs::path folder = folder_of(target);
  std::error_code error;
  const fs::file_status folder_status = fs::status(folder, error);
  if (!fs::exists(folder_status)) {
    refuse(path, fmt::format("the folder '{}' does not exist", folder.string()));
  }
  if (!fs::is_directory(folder_status)) {
    refuse(path, fmt::format("'{}' is not a folder", folder.string()));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    refuse(path, fmt::format("the folder '{}' cannot be written: {}", folder.string(), describe(errno)));
  }
  const fs::file_status status = fs::status(target, error);
  if (status.type() == fs::file_type::none) refuse(path, error.message());
  if (fs::is_directory(status)) refuse(path, "it is a folder");
  if (fs::exists(status) && ::access(target.c_str(), W_OK) != 0) {
    refuse(path, fmt::format("it exists and cannot be written: {}", describe(errno)));
  }
  // Renaming over a device or a pipe would replace it.
  if (fs::exists(status) && !fs::is_regular_file(status)) refuse(path, "it is not a regular file");
}

AtomicFile::AtomicFile(const fs::path& path) : target_(replaced_file(path)) {
  check_writable(path);
  static std::atomic<unsigned> counter{0};
  // The name is short and independent of the target, whose name may already have the maximum length.
  temporary_ = folder_of(target_) / fmt::format(".gatelight-{}-{}.tmp", ::getpid(), counter.fetch_add(1));
  // With 0666 the umask decides the permissions, as for any other file.
  int descriptor = open_nameless(folder_of(target_));
  named_ = descriptor < 0;
  if (named_) descriptor = ::open(temporary_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) fail(errno);
  stream_ = ::fdopen(descriptor, "w+b");
  if (stream_ == nullptr) {
    const int error = errno;
    ::close(descriptor);
    if (named_) ::unlink(temporary_.c_str());
    fail(error);
  }
}

AtomicFile::~AtomicFile() {
  if (stream_ == nullptr) return;
  std::fclose(stream_);
  if (named_) ::unlink(temporary_.c_str());
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  if (std::fwrite(data, 1, bytes, stream_) != bytes) fail(errno);
}

void AtomicFile::commit() {
  // When a write fails inside a seek, the next flush does not report it, but ferror() does.
  if (std::ferror(stream_) != 0) refuse(target_, "it could not be written completely");
  if (std::fflush(stream_) != 0 || ::fsync(::fileno(stream_)) != 0) fail(errno);
  const std::string link = link_of(::fileno(stream_));
  const auto link_to = [&](const fs::path& name) {
    return ::linkat(AT_FDCWD, link.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  };
  const bool is_new = !named_ && link_to(target_);
  if (!named_ && !is_new) {
    // A link cannot replace a file. So the file gets a temporary name now, and a rename replaces the target.
    const auto give_name = [&] { return link_to(temporary_); };
    // A process with the same number may have been killed right here and left the name behind.
    if (!give_name() && (errno != EEXIST || ::unlink(temporary_.c_str()) != 0 || !give_name())) fail(errno);
    named_ = true;
  }
  if (!is_new && ::rename(temporary_.c_str(), target_.c_str()) != 0) fail(errno);
  std::fclose(stream_);  // everything is flushed already
  stream_ = nullptr;
  sync_folder(folder_of(target_));
}

void AtomicFile::fail(int error) const {
  refuse(target_, describe(error));
}

void write_file_atomically(const fs::path& path, std::string_view content) {
  AtomicFile file(path);
  file.write(content.data(), content.size());
  file.commit();
}

}  // namespace gatelight
