#pragma once
// results.md: the tables of a sweep.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace gatelight::apps {

/// Markdown of means over the seeds. The first table has a row for each scene, with named runs beside
/// denoised paths, where there are named runs; the second one has a row for each run and number of steps or
/// samples.
std::string results_table(const nlohmann::ordered_json& results);

}  // namespace gatelight::apps
