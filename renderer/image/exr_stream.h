#pragma once
// A stdio stream that OpenEXR writes to.

#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfThreading.h>
#include <tbb/global_control.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <system_error>

namespace gatelight::renderer {

/// Goes back to fill in the table of line offsets, so the stream must seek.
class StdioStream final : public Imf::OStream {
 public:
  explicit StdioStream(std::FILE* stream) : Imf::OStream("stream"), stream_(stream) {}

  void write(const char* data, int bytes) override {
    if (std::fwrite(data, 1, static_cast<std::size_t>(bytes), stream_) != static_cast<std::size_t>(bytes)) {
      fail();
    }
  }
  std::uint64_t tellp() override {
    const long position = std::ftell(stream_);
    if (position < 0) fail();
    return static_cast<std::uint64_t>(position);
  }
  /// The library finishes a file in a destructor, which hides errors.
  void check() const {
    if (error_ != 0) throw_error();
  }
  void seekp(std::uint64_t position) override {
    if (std::fseek(stream_, static_cast<long>(position), SEEK_SET) != 0) fail();
  }

 private:
  [[noreturn]] void throw_error() const {
    throw std::system_error(error_, std::generic_category(), "stream");
  }
  [[noreturn]] void fail() {
    if (error_ == 0) error_ = errno;
    throw_error();
  }

  std::FILE* stream_;
  int error_ = 0;
};

/// Threads with which the library writes; 0: it works in the caller's.
inline int exr_threads() {
  const auto threads =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  // Another number replaces the library's pool, in which another thread may already write.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  if (threads > 1 && Imf::globalThreadCount() < threads) Imf::setGlobalThreadCount(threads);
  return threads > 1 ? threads : 0;
}

}  // namespace gatelight::renderer
