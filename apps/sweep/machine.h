#pragma once
// Whose seconds a cell has.

#include <string>

#include "renderer/settings/options.h"

namespace gatelight::apps {

/// As the processor names itself.
std::string cpu_name();

/// The processor and the instruction sets that the options choose on it: with others a cell takes other
/// seconds and has other last digits.
std::string machine_text(const renderer::RenderOptions& options);

}  // namespace gatelight::apps
