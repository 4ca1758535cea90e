#pragma once
// JSON that was written by an earlier run, or by anybody.

#include <filesystem>
#include <nlohmann/json.hpp>

namespace gatelight::apps {

/// A discarded value (is_discarded()) where there is no such file, no JSON in it, or JSON that is nested deeper
/// than ours: copying and printing values takes a call for each level.
nlohmann::ordered_json read_json_file(const std::filesystem::path& path);

}  // namespace gatelight::apps
