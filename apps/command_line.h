#pragma once

namespace gatelight::apps {

/// The whole program. Answers the exit code; throws nothing.
int run(int argc, const char* const* argv);

}  // namespace gatelight::apps
