// The server of a window, over sockets.

#include "apps/view/web_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include "base/errors.h"

namespace gatelight::apps {
namespace {

/// What the server sends back to some bytes, until it closes or is silent for so long.
std::string exchange(int port, const std::string& bytes, int limit_ms = 2000) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  const timeval limit{limit_ms / 1000, limit_ms % 1000 * 1000};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<std::uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer;
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0) {
    ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    char buffer[4096];
    for (ssize_t count; (count = ::recv(socket, buffer, sizeof buffer, 0)) > 0;)
      answer.append(buffer, static_cast<std::size_t>(count));
  } else {
    answer = "refused";
  }
  ::close(socket);
  return answer;
}

class Server : public ::testing::Test {
 protected:
  Server()
      : server_(0,
                [this](const WebRequest& request) {
                  ++asked_;
                  return WebResponse{.body = request.method + " " + request.path + " " + request.body};
                }),
        thread_([this] { server_.serve(); }) {
    secret_ = server_.address().substr(server_.address().find('/', 7));
  }
  ~Server() override {
    server_.stop();
    thread_.join();
  }

  std::string host() const { return "127.0.0.1:" + std::to_string(server_.port()); }
  std::string request(const std::string& line, const std::string& headers = "", const std::string& body = "",
                      const std::string& host_name = "") const {
    return exchange(server_.port(), line + " HTTP/1.1\r\nHost: " + (host_name.empty() ? host() : host_name) +
                                        "\r\n" + headers + "Connection: close\r\nContent-Length: " +
                                        std::to_string(body.size()) + "\r\n\r\n" + body);
  }

  std::atomic<int> asked_ = 0;
  WebServer server_;
  std::thread thread_;
  std::string secret_;  ///< "/0123.../"
};

TEST_F(Server, AnswersUnderItsAddress) {
  const std::string answer = request("GET " + secret_ + "api/status?viewer=a");
  EXPECT_EQ(answer.substr(0, 15), "HTTP/1.1 200 OK") << answer;
  EXPECT_NE(answer.find("GET api/status "), std::string::npos);
  EXPECT_NE(answer.find("Content-Security-Policy: default-src 'none'"), std::string::npos);
  EXPECT_NE(request("POST " + secret_ + "x", "", "body").find("POST x body"), std::string::npos);
}

TEST_F(Server, GivesNothingWithoutTheSecret) {
  std::string wrong = secret_;
  wrong[5] = wrong[5] == '0' ? '1' : '0';
  for (const std::string& path :
       {std::string("/"), std::string("/index.html"), wrong, secret_.substr(0, 20) + "/", "/x" + secret_,
        "/" + std::string(32, '0') + "/", std::string("*"), secret_.substr(1)}) {
    const std::string answer = request("GET " + path);
    EXPECT_EQ(answer.find(" 200 "), std::string::npos) << path;
    EXPECT_NE(answer.find("Content-Length: 0"), std::string::npos) << answer;
  }
  EXPECT_EQ(asked_, 0);
}

TEST_F(Server, GivesNothingToPagesElsewhere) {
  for (const char* name : {"evil.example", "127.0.0.1", "127.0.0.1:1", "localhost.evil.example"})
    EXPECT_EQ(request("GET " + secret_, "", "", name).substr(0, 12), "HTTP/1.1 404") << name;
  EXPECT_EQ(request("POST " + secret_, "Origin: http://evil.example\r\n", "x").substr(0, 12), "HTTP/1.1 404");
  EXPECT_EQ(asked_, 0);
  EXPECT_EQ(request("POST " + secret_, "Origin: http://" + host() + "\r\n", "x").substr(0, 12),
            "HTTP/1.1 200");
}

TEST_F(Server, ListensOnTheLoopbackOnly) {
  // All listening sockets with this port, as the kernel lists them.
  std::ifstream table("/proc/net/tcp");
  char port[8];
  std::snprintf(port, sizeof port, ":%04X", server_.port());
  int listening = 0;
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::string number, local, remote, state;
    words >> number >> local >> remote >> state;
    if (local.size() != 13 || local.substr(8) != port || state != "0A") continue;
    EXPECT_EQ(local.substr(0, 8), "0100007F");
    ++listening;
  }
  EXPECT_EQ(listening, 1);
}

TEST_F(Server, RefusesAPortThatIsTaken) {
  EXPECT_THROW(WebServer(server_.port(), [](const WebRequest&) { return WebResponse{}; }), BadOption);
}

TEST_F(Server, RefusesLargeBodies) {
  EXPECT_EQ(request("POST " + secret_, "", std::string(1 << 20, 'x')).find(" 200 "), std::string::npos);
  EXPECT_EQ(asked_, 0);
}

/// Right requests with bytes changed, cut and repeated.
TEST_F(Server, SurvivesAnyBytes) {
  std::mt19937 random(3);
  const std::string right = "POST " + secret_ + "api/change?viewer=a HTTP/1.1\r\nHost: " + host() +
                            "\r\nContent-Length: 4\r\nConnection: close\r\nTransfer-Encoding: "
                            "chunked\r\nRange: bytes=0-3\r\n\r\nbody";
  for (int i = 0; i < 300; ++i) {
    std::string bytes = right;
    for (std::uint32_t k = random() % 6; k > 0; --k) {
      const std::size_t at = random() % bytes.size();
      switch (random() % 4) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes.erase(at, random() % 9);
          break;
        case 2:
          bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 40));
          break;
        default:
          bytes.insert(at, std::string(random() % 2000, 'A'));
          break;
      }
    }
    exchange(server_.port(), bytes, 10);
  }
  EXPECT_EQ(request("GET " + secret_).substr(0, 15), "HTTP/1.1 200 OK");
}

}  // namespace
}  // namespace gatelight::apps
