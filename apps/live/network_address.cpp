#include "apps/live/network_address.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/settings/parsing.h"
#include "base/errors.h"

namespace gatelight::apps {
namespace {

constexpr std::size_t kLongestHost = 255;

bool fits_host(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '.' ||
         c == '_' || c == ':' || c == '%';
}

}  // namespace

std::string NetworkAddress::text() const {
  return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port)
                                             : fmt::format("[{}]:{}", host, port);
}

NetworkAddress parse_network_address(const std::string& flag, const std::string& text, int default_port) {
  NetworkAddress address{text, default_port};
  const std::size_t bracket = text.starts_with('[') ? text.find(']') : std::string::npos;
  const std::size_t colon = text.find(':', bracket == std::string::npos ? 0 : bracket);
  if (colon != std::string::npos) {
    address.host = text.substr(0, colon);
    address.port = static_cast<int>(parse_integer(flag, text.substr(colon + 1), {1, 65535}));
  }
  if (bracket != std::string::npos && bracket + 1 == address.host.size())
    address.host = address.host.substr(1, bracket - 1);
  if (address.host.empty() || address.host.size() > kLongestHost ||
      !std::all_of(address.host.begin(), address.host.end(), fits_host))
    throw BadOption(fmt::format("{}: '{}' is no address, expected HOST or HOST:PORT", flag, text));
  return address;
}

}  // namespace gatelight::apps
