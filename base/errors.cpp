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

Error::Error(ErrorKind kind, ErrorParts parts)
    : std::runtime_error(sentence(parts)), kind_(kind), parts_(std::move(parts)) {}

}  // namespace gatelight
