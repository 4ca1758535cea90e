#include "base/errors.h"

#include <fmt/format.h>

namespace gatelight {

std::string sentence(const ErrorParts& parts) {
  const auto& [option, value, problem, expected, hint] = parts;
  std::string text = option.empty() ? "" : option + ": ";
  if (problem.empty()) return text + fmt::format("'{}' is not {}{}", value, expected, hint);
  if (!value.empty()) text += fmt::format("'{}' ", value);
  return text + problem + (expected.empty() ? "" : ", expected " + expected) + hint;
}

std::string one_line(std::string text) {
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = ' ';
  }
  return text;
}

Error::Error(ErrorKind kind, ErrorParts parts)
    : std::runtime_error(sentence(parts)), kind_(kind), parts_(std::move(parts)) {}

}  // namespace gatelight
