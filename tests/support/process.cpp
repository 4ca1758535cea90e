#include "tests/support/process.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <sstream>
#include <stdexcept>

#include "apps/command_line.h"
#include "apps/terminal/log.h"

namespace gatelight::tests {
namespace {

constexpr int kPatienceMs = 60000;

void close_once(int& descriptor) {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

}  // namespace

std::vector<std::string> Output::error_lines() const {
  std::vector<std::string> lines;
  std::istringstream text(err);
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> Output::warnings() const {
  std::vector<std::string> lines = error_lines();
  std::erase_if(lines, [](const std::string& line) { return !line.starts_with("gatelight: warning: "); });
  return lines;
}

Process::Process(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
  std::vector<std::string> words = {GATELIGHT_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  int out[2];
  int err[2];
  if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("pipe2 failed");
  pid_ = ::fork();
  if (pid_ == 0) {
    ::dup2(out[1], STDOUT_FILENO);
    ::dup2(err[1], STDERR_FILENO);
    if (prepare) prepare();
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ::close(out[1]);
  ::close(err[1]);
  out_ = out[0];
  err_ = err[0];
}

Process::~Process() {
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  close_once(out_);
  close_once(err_);
}

void Process::send(int signal) const {
  ::kill(pid_, signal);
}

bool Process::runs() const {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == 0;
}

bool Process::read_some(int timeout_ms) {
  pollfd descriptors[2] = {{out_, POLLIN, 0}, {err_, POLLIN, 0}};
  if (::poll(descriptors, 2, timeout_ms) <= 0) {
    ::kill(pid_, SIGKILL);
    return false;
  }
  char buffer[4096];
  const auto drain = [&](int& descriptor, short events, std::string& text) {
    if (descriptor < 0 || (events & (POLLIN | POLLHUP)) == 0) return;
    const ssize_t count = ::read(descriptor, buffer, sizeof buffer);
    if (count > 0) {
      text.append(buffer, static_cast<std::size_t>(count));
    } else {
      close_once(descriptor);
    }
  };
  drain(out_, descriptors[0].revents, output_.out);
  drain(err_, descriptors[1].revents, output_.err);
  return out_ >= 0 || err_ >= 0;
}

bool Process::wait_for_error_text(const std::string& text) {
  while (output_.err.find(text) == std::string::npos) {
    if (!read_some(kPatienceMs)) return output_.err.find(text) != std::string::npos;
  }
  return true;
}

Output Process::finish() {
  while (read_some(kPatienceMs)) {
  }
  int status = 0;
  ::waitpid(pid_, &status, 0);
  pid_ = -1;
  output_.killed = WIFSIGNALED(status);
  output_.exit_code = output_.killed ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  return output_;
}

Output run_gatelight_inside(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"gatelight"};
  for (const std::string& word : arguments) argv.push_back(word.c_str());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  apps::set_log_level(false, false);  // whatever a run before has set
  Output output;
  output.exit_code = apps::run(static_cast<int>(argv.size()), argv.data());
  output.out = ::testing::internal::GetCapturedStdout();
  output.err = ::testing::internal::GetCapturedStderr();
  return output;
}

Output run_gatelight(const std::vector<std::string>& arguments, const std::function<void()>& prepare) {
  return Process(arguments, prepare).finish();
}

Output expect_done(Output output, Place place) {
  const ::testing::ScopedTrace trace(place.file, place.line, "stderr: " + output.err);
  EXPECT_EQ(output.exit_code, 0);
  return output;
}

void expect_failure(const Output& output, int exit_code, const NameList& names, Place place) {
  const ::testing::ScopedTrace trace(place.file, place.line, "stderr: " + output.err);
  EXPECT_EQ(output.exit_code, exit_code);
  EXPECT_FALSE(output.killed);
  EXPECT_EQ(output.error_lines().size(), 1u);
  EXPECT_EQ(output.last_error_line().rfind("gatelight: error: ", 0), 0u);
  expect_message(output.last_error_line(), names, place);
}

}  // namespace gatelight::tests
