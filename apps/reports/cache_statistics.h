#pragma once
// Statistics and the report of the cache as JSON and as text.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "renderer/cache/cache_report.h"
#include "renderer/settings/statistics.h"

namespace gatelight::apps {

/// The parts of the statistics file that only a cache has: "train", "cache", and its share of "memory_bytes".
nlohmann::ordered_json training_json(const renderer::CacheStatistics& statistics);
nlohmann::ordered_json cache_json(const renderer::CacheStatistics& statistics);
nlohmann::ordered_json cache_memory_json(const renderer::CacheStatistics& statistics);

/// Seconds of scouting, setting up and training.
nlohmann::ordered_json cache_seconds_json(const renderer::CacheStatistics& statistics);

/// A few lines, each with its line break. cache_in: the file that the cache was loaded from; empty for none.
std::string cache_summary(const renderer::CacheStatistics& statistics, const std::string& cache_in);

/// The report of `gatelight info SCENE --integrator nao|nrc` on the cache. Lines, each with its line break.
std::string cache_report_text(const renderer::CacheReport& report, const renderer::RenderOptions& options);
nlohmann::ordered_json cache_report_json(const renderer::CacheReport& report,
                                         const renderer::RenderOptions& options);

}  // namespace gatelight::apps
