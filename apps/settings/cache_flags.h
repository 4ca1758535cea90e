#pragma once

namespace CLI {
class App;
}

namespace gatelight::apps {

struct RenderSettings;

/// Binds what a cache is, learns and answers. The settings must outlive the parsing.
void add_cache_flags(CLI::App& app, RenderSettings& settings);
/// --cache-in and --cache-out.
void add_cache_file_flags(CLI::App& app, RenderSettings& settings);
void add_preset_flag(CLI::App& app, RenderSettings& settings);

/// After parsing: applies the preset, and reads over it all flags that were given, wherever they stood.
/// Notes in the settings which of them only a cache understands.
void finish_flags(CLI::App& app, RenderSettings& settings);

}  // namespace gatelight::apps
