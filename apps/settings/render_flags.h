#pragma once

#include <string>

namespace CLI {
class App;
}

namespace gatelight::apps {

struct RenderSettings;

/// Binds the flags of `render`. The settings must outlive the parsing; finish_flags() comes after it.
void add_render_flags(CLI::App& app, RenderSettings& settings);
/// Those of them that decide what the cache of a scene is, for `info`.
void add_cache_report_flags(CLI::App& app, RenderSettings& settings);
/// --allow-external, which `sweep` has, too.
void add_external_flag(CLI::App& app, bool& allowed, const std::string& group);

}  // namespace gatelight::apps
