#pragma once
// The flag --schedule.

#include <string>

namespace gatelight::bench {

/// The file into which the schedule of a picture is written; empty: nothing is recorded.
std::string& schedule_file();

}  // namespace gatelight::bench
