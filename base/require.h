#pragma once

#include <fmt/format.h>

#include "base/errors.h"

namespace gatelight {

/// Throws BadConfiguration about an option of this name unless the condition holds.
template <typename Number>
void require(bool holds, const char* option, Number value, const char* expected) {
  if (!holds)
    throw BadConfiguration({.option = option, .value = fmt::format("{}", value), .expected = expected});
}

}  // namespace gatelight
