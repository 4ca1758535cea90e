#pragma once

namespace CLI {
class App;
}

namespace gatelight::apps {

struct RenderSettings;

/// Binds the flags of `render`. The settings must outlive the parsing.
void add_render_flags(CLI::App& app, RenderSettings& settings);

}  // namespace gatelight::apps
