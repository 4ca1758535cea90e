#pragma once
// The report of a sweep: one self-contained HTML file.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace gatelight::apps {

/// `results` is results.json. Pictures, error maps and references are read from `folder` unless their paths
/// are absolute; the page says where one is missing or cannot be read. References have the exposure and curve
/// of the PNGs of their cells.
std::string make_report(const nlohmann::ordered_json& results, const std::string& folder);

}  // namespace gatelight::apps
