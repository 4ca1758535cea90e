#pragma once
// The flag --schedule.

#include <string>

namespace gatelight::bench {

/// The file into which the schedule of the last row is written; empty: nothing is recorded.
std::string& schedule_file();
void write_schedule(const std::string& json);

}  // namespace gatelight::bench
