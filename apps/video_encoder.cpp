#include "apps/video_encoder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <system_error>

#include "apps/settings/frame_flags.h"
#include "base/errors.h"
#include "base/file/atomic_file.h"

namespace gatelight::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kPollMilliseconds = 100;

std::string message_of(int error) {
  return std::generic_category().message(error);
}

/// The last line that is not empty.
std::string last_line(std::FILE* file) {
  std::rewind(file);
  std::string text;
  char buffer[4096];
  for (std::size_t count; (count = std::fread(buffer, 1, sizeof buffer, file)) > 0;)
    text.append(buffer, count);
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (line.find_first_not_of(" \t\r") != std::string::npos) last = line;
  }
  return last;
}

/// The picture with its last column and row once more, as far as the film is larger.
std::vector<std::uint8_t> extended(std::span<const std::uint8_t> rgb, const FilmSize& from,
                                   const FilmSize& to) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(to.width) * static_cast<std::size_t>(to.height) * 3);
  const std::size_t row = static_cast<std::size_t>(from.width) * 3;
  for (int y = 0; y < to.height; ++y) {
    const auto line = rgb.subspan(static_cast<std::size_t>(std::min(y, from.height - 1)) * row, row);
    bytes.insert(bytes.end(), line.begin(), line.end());
    if (to.width > from.width) bytes.insert(bytes.end(), line.end() - 3, line.end());
  }
  return bytes;
}

}  // namespace

std::string find_encoder() {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder.empty() ? "." : folder) / "ffmpeg";
    std::error_code ignored;
    if (fs::is_regular_file(program, ignored) && ::access(program.c_str(), X_OK) == 0)
      return program.string();
  }
  throw MissingLibrary(
      "--preview-video: there is no program 'ffmpeg' in PATH; frames in PNG become a film elsewhere, by "
      "ffmpeg -framerate 24 -i frame-%04d.png -pix_fmt yuv420p film.mp4");
}

VideoEncoder::VideoEncoder(const fs::path& file, const FilmSize& size)
    : file_(file),
      target_(fs::absolute(replaced_file(file))),
      temporary_(target_.parent_path() / fmt::format(".film-{}{}", ::getpid(), target_.extension().string())),
      size_(size),
      film_size_(size),
      errors_(std::tmpfile(), &std::fclose) {
  if (film_format(file.string()) != "gif") {
    film_size_.width += size.width % 2;
    film_size_.height += size.height % 2;
  }
  if (!errors_) fail(fmt::format("no temporary file: {}", message_of(errno)));
  start(find_encoder());
}

VideoEncoder::~VideoEncoder() {
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    end();
  }
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

std::vector<std::string> VideoEncoder::arguments(const std::string& program) const {
  const std::string_view format = film_format(file_.string());
  std::vector<std::string> words = {program, "-hide_banner", "-loglevel", "error", "-nostdin", "-y"};
  const auto add = [&](std::initializer_list<std::string> more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  add({"-f", "rawvideo", "-pixel_format", "rgb24", "-video_size",
       fmt::format("{}x{}", film_size_.width, film_size_.height), "-framerate", fmt::format("{}", size_.fps),
       "-i", "pipe:0"});
  if (format == "gif") {
    // A palette for each frame: one for all would need all frames in memory.
    add({"-vf", "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1"});
  } else {
    // The usual film has the primaries of sRGB, but other coefficients than ffmpeg takes by default.
    add({"-vf",
         "scale=out_color_matrix=bt709:out_range=tv,"
         "setparams=range=tv:colorspace=bt709:color_primaries=bt709:color_trc=bt709,format=yuv420p"});
  }
  if (format == "webm") add({"-b:v", "0", "-crf", "30"});
  if (format == "mp4" || format == "mov") add({"-movflags", "+faststart"});
  // With a protocol and an absolute path no name is taken for a flag or for another protocol.
  add({"-f", std::string(format), "file:" + temporary_.string()});
  return words;
}

void VideoEncoder::start(const std::string& program) {
  std::vector<std::string> words = arguments(program);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail(fmt::format("no pipe: {}", message_of(errno)));
  pipe_ = ends[1];
  ::fcntl(pipe_, F_SETFL, O_NONBLOCK);  // the program's end stays as it is

  posix_spawn_file_actions_t files;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
  ::posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  ::posix_spawn_file_actions_adddup2(&files, ::fileno(errors_.get()), STDERR_FILENO);
  posix_spawnattr_t attributes;
  ::posix_spawnattr_init(&attributes);
  sigset_t usual;
  ::sigemptyset(&usual);
  ::sigaddset(&usual, SIGPIPE);
  ::sigaddset(&usual, SIGXFSZ);
  ::posix_spawnattr_setsigdefault(&attributes, &usual);
  ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  const int error = ::posix_spawn(&process_, program.c_str(), &files, &attributes, argv.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  ::close(ends[0]);
  if (error == 0) return;
  process_ = -1;
  ::close(pipe_);
  fail(fmt::format("'{}' cannot be started: {}", program, message_of(error)));
}

void VideoEncoder::fail(const std::string& reason) const {
  throw OutputError(fmt::format("cannot write '{}': {}", file_.string(), reason));
}

std::string VideoEncoder::end() {
  ::close(pipe_);
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  const std::string said = last_line(errors_.get());
  if (!said.empty()) return "ffmpeg: " + said;
  return WIFEXITED(status) ? fmt::format("ffmpeg ended with code {}", WEXITSTATUS(status))
                           : fmt::format("ffmpeg was ended by signal {}", WTERMSIG(status));
}

bool VideoEncoder::add(std::span<const std::uint8_t> rgb, const std::function<bool()>& stop) {
  const std::vector<std::uint8_t> bytes = extended(rgb, size_, film_size_);
  for (std::size_t done = 0; done < bytes.size();) {
    pollfd ready{pipe_, POLLOUT, 0};
    ::poll(&ready, 1, kPollMilliseconds);
    if (stop()) return false;
    const ssize_t count = ::write(pipe_, bytes.data() + done, bytes.size() - done);
    if (count >= 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EAGAIN && errno != EINTR) {
      const std::string why = end();
      fail(why.empty() ? "ffmpeg ended before the last frame" : why);
    }
  }
  return true;
}

void VideoEncoder::finish() {
  if (const std::string why = end(); !why.empty()) fail(why);
  std::error_code error;
  fs::rename(temporary_, target_, error);
  if (error) fail(error.message());
}

}  // namespace gatelight::apps
