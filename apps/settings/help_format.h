#pragma once

#include <CLI/CLI.hpp>

#include <memory>

namespace gatelight::apps {

/// Formats the help of each flag, wrapped to the terminal, with the default at its end.
std::shared_ptr<CLI::Formatter> make_help_formatter();

}  // namespace gatelight::apps
