#pragma once

#include <fmt/format.h>

#include <string_view>

#include "base/errors.h"

namespace gatelight {

/// Throws BadConfiguration("what: value, expected ...") unless the condition holds.
template <typename Number>
void require(bool holds, std::string_view what, Number value, std::string_view expected) {
  if (!holds) throw BadConfiguration(fmt::format("{}: {}, expected {}", what, value, expected));
}

}  // namespace gatelight
