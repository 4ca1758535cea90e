#pragma once
// The page of a sweep: one HTML file that needs nothing else.

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace gatelight::apps {

/// `results` is results.json (schema 1). Pictures, error maps and references are read from `folder`; one that
/// is not there or cannot be read is left out of the page.
std::string make_report(const nlohmann::ordered_json& results, const std::string& folder);

}  // namespace gatelight::apps
