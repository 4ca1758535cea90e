#include "apps/live/tcp_sender.h"

#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <memory>
#include <stdexcept>
#include <system_error>

namespace gatelight::apps {
namespace {

constexpr int kConnectMilliseconds = 1000;
constexpr int kSendMilliseconds = 5000;

[[noreturn]] void fail(int error) {
  throw std::runtime_error(std::generic_category().message(error));
}

/// Zero, or the error.
int wait_for(int socket, int milliseconds) {
  pollfd state{socket, POLLOUT, 0};
  int ready = 0;
  do ready = poll(&state, 1, milliseconds);
  while (ready < 0 && errno == EINTR);
  if (ready < 0) return errno;
  return ready == 0 ? ETIMEDOUT : 0;
}

int connect_to(int socket, const addrinfo& address) {
  if (connect(socket, address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  if (const int error = wait_for(socket, kConnectMilliseconds); error != 0) return error;
  int error = 0;
  socklen_t size = sizeof error;
  return getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

}  // namespace

TcpSender::TcpSender(const NetworkAddress& address) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int failure = getaddrinfo(address.host.c_str(), std::to_string(address.port).c_str(), &hints, &found);
  if (failure != 0) throw std::runtime_error(gai_strerror(failure));
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, freeaddrinfo);
  int error = EHOSTUNREACH;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    socket_ = socket(one->ai_family, one->ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, one->ai_protocol);
    error = socket_ < 0 ? errno : connect_to(socket_, *one);
    if (error == 0) return;
    if (socket_ >= 0) close(socket_);
  }
  fail(error);
}

TcpSender::~TcpSender() {
  close(socket_);
}

void TcpSender::send(const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
    if (count >= 0) {
      sent += static_cast<std::size_t>(count);
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      if (const int error = wait_for(socket_, kSendMilliseconds); error != 0) fail(error);
    } else if (errno != EINTR) {
      fail(errno);
    }
  }
}

}  // namespace gatelight::apps
