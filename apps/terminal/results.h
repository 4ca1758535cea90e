#pragma once
// Text results: to stdout or to a file.

#include <string>

namespace gatelight::apps {

/// `target` is a file or "-" for stdout. Throws renderer::OutputError, for a closed or full stdout too.
void write_text(const std::string& target, const std::string& text);

}  // namespace gatelight::apps
