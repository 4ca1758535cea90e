#pragma once

#include "apps/settings/light_flags.h"
#include "apps/settings/option.h"
#include "apps/settings/visibility_flags.h"

namespace gatelight::apps {

/// The value of an option that is a list with a text_of(): its text, or none.
inline constexpr auto list_value = [](const auto& list) -> OptionValue {
  return list.empty() ? OptionValue() : text_of(list);
};

}  // namespace gatelight::apps
