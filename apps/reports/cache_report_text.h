#pragma once
// The report of `gatelight info SCENE --integrator nao|nrc` on the cache.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "renderer/cache/cache_report.h"

namespace gatelight::apps {

/// Lines, each with its line break.
std::string cache_report_text(const renderer::CacheReport& report, const renderer::RenderOptions& options);
nlohmann::ordered_json cache_report_json(const renderer::CacheReport& report,
                                         const renderer::RenderOptions& options);

}  // namespace gatelight::apps
