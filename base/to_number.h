#pragma once
// Numbers in text.

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace gatelight {

/// The number that the whole text is, in C's notation whatever the locale; none if it is another text or is
/// out of the type's range. "inf" and "nan" are numbers of floating-point types.
template <class Number>
std::optional<Number> to_number(std::string_view text) {
  Number number{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end) return std::nullopt;
  return number;
}

}  // namespace gatelight
