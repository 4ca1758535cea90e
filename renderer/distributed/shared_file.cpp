#include "renderer/distributed/shared_file.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>

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

SharedFile share_file(Ranks& ranks, const std::filesystem::path& path) {
  if (ranks.is_single()) return {path, nullptr};
  Bytes bytes = ranks.first() ? read_bytes(path) : Bytes();
  ranks.broadcast(bytes);
  if (ranks.first()) return {path, nullptr};
  const int descriptor = ::memfd_create("gatelight", MFD_CLOEXEC);
  SharedFile file{fmt::format("/proc/self/fd/{}", descriptor),
                  std::shared_ptr<void>(nullptr, [descriptor](void*) { ::close(descriptor); })};
  for (std::size_t done = 0; descriptor >= 0 && done < bytes.size();) {
    const ::ssize_t written = ::write(descriptor, &bytes[done], bytes.size() - done);
    if (written <= 0) break;
    done += static_cast<std::size_t>(written);
  }
  if (descriptor < 0 || std::filesystem::file_size(file.path) != bytes.size()) {
    throw std::system_error(errno, std::generic_category(),
                            fmt::format("no room in memory for '{}'", path.string()));
  }
  return file;
}

}  // namespace gatelight::renderer
