#pragma once
// Limits that control groups set for this process.

#include <filesystem>
#include <functional>
#include <limits>
#include <string>

namespace gatelight::renderer {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// What a group's folder sets as its limit; kUnlimited: none.
using ReadLimit = std::function<double(const std::filesystem::path& folder)>;

/// The tightest limit of the process's groups and all their ancestors, kUnlimited where there is none. `v2`
/// reads the folders of the unified hierarchy, `v1` those of `controller`. `root` is where /proc and
/// /sys/fs/cgroup are looked for.
double tightest_limit(const std::filesystem::path& root, const std::string& controller, const ReadLimit& v2,
                      const ReadLimit& v1);

}  // namespace gatelight::renderer
