#pragma once

namespace gatelight::apps {

/// Reads the command line, a --config file in it too, and runs nothing: 0, or the exit code of what is wrong
/// with it, which has been said on stderr. Throws nothing.
int read_only(int argc, const char* const* argv);

/// The whole program. Answers the exit code; throws nothing.
int run(int argc, const char* const* argv);

}  // namespace gatelight::apps
