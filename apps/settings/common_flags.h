#pragma once

#include <set>
#include <string>

namespace gatelight::apps {

/// The flags of `render` that most people use, without their dashes: those of `render --help`.
const std::set<std::string>& common_flags();

}  // namespace gatelight::apps
