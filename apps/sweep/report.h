#pragma once
// The report of a sweep: one self-contained HTML file.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace gatelight::apps {

/// `results` is results.json. Pictures, error maps and references are read from `folder` unless their paths
/// are absolute; files that are missing or cannot be read are left out. References have the exposure and
/// curve of the PNGs of their cells. Many pictures are scaled down, so that a phone can open the page.
std::string make_report(const nlohmann::ordered_json& results, const std::string& folder);

}  // namespace gatelight::apps
