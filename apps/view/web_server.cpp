#include "apps/view/web_server.h"

#include <fmt/format.h>
#include <httplib.h>

#include <atomic>
#include <chrono>
#include <random>
#include <thread>
#include <utility>

#include "base/errors.h"

namespace gatelight::apps {
namespace {

constexpr const char* kHost = "127.0.0.1";
constexpr std::size_t kMaxBody = 1 << 16;
/// Each page has up to two requests that wait for news.
constexpr std::size_t kThreads = 32;
constexpr int kSeconds = 5;

std::string random_secret() {
  std::random_device device;  // of the operating system
  std::string secret;
  for (int i = 0; i < 4; ++i) secret += fmt::format("{:08x}", device());
  return secret;
}

/// Equal lengths take equal time, so that a guess learns nothing.
bool same(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    different |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return different == 0;
}

}  // namespace

struct WebServer::Implementation {
  httplib::Server server;
  std::string secret = random_secret();
  std::string address;
  int port = 0;
  std::atomic<bool> serving = false, stopped = false;

  /// Whether a browser on this machine asks for this very address. A page elsewhere could let its own name
  /// mean this machine, or send its forms here.
  bool is_own(const httplib::Request& request) const {
    const std::string host = request.get_header_value("Host");
    if (host != fmt::format("{}:{}", kHost, port) && host != fmt::format("localhost:{}", port)) return false;
    const std::string origin = request.get_header_value("Origin");
    return origin.empty() || origin == "http://" + host;
  }

  void handle(const httplib::Request& request, httplib::Response& response,
              const AnswerRequest& answer) const {
    const std::string prefix = "/" + secret + "/";
    if (!is_own(request) || !same(request.path.substr(0, prefix.size()), prefix)) {
      response.status = 404;
      return;
    }
    WebRequest asked{request.method, request.path.substr(prefix.size()), {}, request.body};
    for (const auto& [name, value] : request.params) asked.query.emplace(name, value);
    WebResponse answered = answer(asked);
    response.status = answered.status;
    for (const auto& [name, value] : answered.headers) response.set_header(name, value);
    response.set_header("Cache-Control", "no-store");
    response.set_header("X-Content-Type-Options", "nosniff");
    response.set_header("Referrer-Policy", "no-referrer");
    response.set_header(
        "Content-Security-Policy",
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
        "connect-src 'self'; form-action 'none'; frame-ancestors 'none'; base-uri 'none'");
    response.set_content(std::move(answered.body), answered.type);
  }
};

WebServer::WebServer(int port, AnswerRequest answer) : implementation_(std::make_unique<Implementation>()) {
  httplib::Server& server = implementation_->server;
  server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  server.set_payload_max_length(kMaxBody);
  server.set_read_timeout(kSeconds);
  server.set_write_timeout(kSeconds);
  server.set_tcp_nodelay(true);
  // The library's own choice would let another process listen on the same port.
  server.set_socket_options([](socket_t socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  const auto handle = [this, answer = std::move(answer)](const httplib::Request& request,
                                                         httplib::Response& response) {
    implementation_->handle(request, response, answer);
  };
  server.Get(".*", handle);
  server.Post(".*", handle);
  const bool any = port == 0;
  const int bound = any ? server.bind_to_any_port(kHost) : server.bind_to_port(kHost, port) ? port : -1;
  if (bound < 0)
    throw BadOption(
        {"port", fmt::format("{}", port), "cannot be opened for listening", "a free port; 0 takes any"});
  implementation_->port = port = bound;
  implementation_->address = fmt::format("http://{}:{}/{}/", kHost, port, implementation_->secret);
}

WebServer::~WebServer() = default;

const std::string& WebServer::address() const {
  return implementation_->address;
}

int WebServer::port() const {
  return implementation_->port;
}

void WebServer::serve() {
  Implementation& self = *implementation_;
  self.serving = true;
  if (!self.stopped) self.server.listen_after_bind();
  self.serving = false;
}

void WebServer::stop() {
  Implementation& self = *implementation_;
  self.stopped = true;
  // The library forgets a stop that comes before it listens.
  while (self.serving) {
    self.server.stop();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace gatelight::apps
