#pragma once
// The flags of all options of a picture, with their help and values.

#include <vector>

#include "apps/settings/option.h"

namespace gatelight::apps {

/// In the order of the help, bound to the members of `options`, which must outlive them.
std::vector<Option> picture_options(RenderOptions& options);

/// Parts of the table.
void add_view_options(std::vector<Option>& table, renderer::CameraOptions& camera,
                      renderer::EnvironmentOptions& environment, renderer::BackgroundOptions& background);
void add_cache_options(std::vector<Option>& table, renderer::CacheOptions& options);
void add_cache_file_options(std::vector<Option>& table, renderer::CacheOptions& options);

}  // namespace gatelight::apps
