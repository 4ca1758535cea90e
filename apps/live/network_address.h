#pragma once
// A program that listens on a network.

#include <string>

namespace gatelight::apps {

struct NetworkAddress {
  std::string host;  ///< a name, or an IPv4 or IPv6 address
  int port = 0;

  /// "host:port".
  std::string text() const;
};

/// "HOST" or "HOST:PORT"; an IPv6 address stands in brackets. Throws BadOption that names the flag.
NetworkAddress parse_network_address(const std::string& flag, const std::string& text, int default_port);

}  // namespace gatelight::apps
