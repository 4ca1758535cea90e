#include "renderer/distributed/shared_file.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

namespace gatelight::renderer {
namespace {

Bytes read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  Bytes bytes(static_cast<std::size_t>(std::filesystem::file_size(path)));
  file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!file)
    throw std::system_error(errno, std::generic_category(), fmt::format("cannot read '{}'", path.string()));
  return bytes;
}

}  // namespace

SharedFile::SharedFile(SharedFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

SharedFile& SharedFile::operator=(SharedFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

SharedFile::~SharedFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

SharedFile share_file(Ranks& ranks, const std::filesystem::path& path) {
  SharedFile file;
  if (ranks.first()) file.path_ = path;
  if (ranks.is_single()) return file;
  Bytes bytes = ranks.first() ? read_bytes(path) : Bytes();
  ranks.broadcast(bytes);
  if (ranks.first()) return file;
  file.descriptor_ = ::memfd_create("gatelight", MFD_CLOEXEC);
  for (std::size_t done = 0; file.descriptor_ >= 0 && done < bytes.size();) {
    const ::ssize_t written = ::write(file.descriptor_, &bytes[done], bytes.size() - done);
    if (written <= 0) break;
    done += static_cast<std::size_t>(written);
  }
  file.path_ = fmt::format("/proc/self/fd/{}", file.descriptor_);
  if (file.descriptor_ < 0 || std::filesystem::file_size(file.path_) != bytes.size()) {
    throw std::system_error(errno, std::generic_category(),
                            fmt::format("no room in memory for '{}'", path.string()));
  }
  return file;
}

}  // namespace gatelight::renderer
