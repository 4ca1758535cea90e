#pragma once
// The page of a sweep: one HTML file that needs nothing else.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace gatelight::apps {

/// `results` is results.json. Pictures, error maps and references are read from `folder`, or from where their
/// absolute path says; one that is not there or cannot be read is left out of the page. References are shown
/// as the PNGs of their cells. Many pictures are made smaller, so that a phone can open the page.
std::string make_report(const nlohmann::ordered_json& results, const std::string& folder);

}  // namespace gatelight::apps
