#pragma once
// A connection over which bytes are sent.

#include <string>

#include "apps/live/network_address.h"

namespace gatelight::apps {

class TcpSender {
 public:
  /// Throws std::runtime_error with the system's message where nothing answers within a second.
  explicit TcpSender(const NetworkAddress& address);
  ~TcpSender();
  TcpSender(const TcpSender&) = delete;
  TcpSender& operator=(const TcpSender&) = delete;

  /// Throws std::runtime_error where the other side has closed, or takes nothing for five seconds.
  void send(const std::string& bytes);

 private:
  int socket_ = -1;
};

}  // namespace gatelight::apps
