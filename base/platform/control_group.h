#pragma once
// Reads the limits that control groups set for this process.

#include <filesystem>
#include <functional>
#include <limits>
#include <string>

namespace gatelight {

inline constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Reads the limit that a group's folder sets; kUnlimited means no limit.
using ReadLimit = std::function<double(const std::filesystem::path& folder)>;

/// The tightest limit of the process's groups and all their ancestors; kUnlimited means no limit. `v2` reads
/// the folders of the unified hierarchy, `v1` those of `controller`. `root` is the folder that holds proc and
/// sys/fs/cgroup.
double tightest_limit(const std::filesystem::path& root, const std::string& controller, const ReadLimit& v2,
                      const ReadLimit& v1);

}  // namespace gatelight
