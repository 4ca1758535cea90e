#pragma once

#include <nlohmann/json_fwd.hpp>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

/// Options of the cache that apply to its encoding, by the names of their flags and in words that these flags
/// take again. Those that cannot change the picture are left out where `reproducible` is set.
nlohmann::ordered_json resolved_cache_options(const RenderSettings& settings);

}  // namespace gatelight::apps
