#pragma once
// Films by the program ffmpeg, which is started with pictures in its standard input. No library is linked.

#include <sys/types.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gatelight::apps {

/// The path of ffmpeg. Throws MissingLibrary where no folder of PATH has it.
std::string find_encoder();

struct FilmSize {
  int width = 0;
  int height = 0;
  double fps = 24.0;
};

/// A film that is being written, under a temporary name beside its own until it is finished. SIGPIPE is
/// ignored (signals.h).
class VideoEncoder {
 public:
  /// `file`: its extension is that of a film (film_format()). Throws OutputError, or MissingLibrary.
  VideoEncoder(const std::filesystem::path& file, const FilmSize& size);
  /// Ends the program and removes what it wrote, unless finish() was called.
  ~VideoEncoder();
  VideoEncoder(const VideoEncoder&) = delete;
  VideoEncoder& operator=(const VideoEncoder&) = delete;

  /// Three bytes a pixel, rows from the top. Returns false where `stop` ended the wait for the program.
  /// Throws OutputError with the last line of the program's errors.
  bool add(std::span<const std::uint8_t> rgb, const std::function<bool()>& stop);

  /// Gives the film its name. Throws OutputError.
  void finish();

 private:
  std::vector<std::string> arguments(const std::string& program) const;
  void start(const std::string& program);
  [[noreturn]] void fail(const std::string& reason) const;
  /// Waits for the end of the program. Returns why it failed; empty where it did not.
  std::string end();

  std::filesystem::path file_, target_, temporary_;
  FilmSize size_;       ///< of the pictures
  FilmSize film_size_;  ///< most encoders need even numbers: the last column and row come twice
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> errors_;  ///< a file without a name
  pid_t process_ = -1;
  int pipe_ = -1;
};

}  // namespace gatelight::apps
