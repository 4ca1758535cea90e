#pragma once

#include <CLI/CLI.hpp>

#include <memory>

namespace gatelight::apps {

/// Help of one line or more for each flag, wrapped to a terminal, with the default at its end.
std::shared_ptr<CLI::Formatter> make_help_formatter();

}  // namespace gatelight::apps
