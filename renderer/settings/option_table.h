#pragma once
// All options of a picture. Flags, their help, recipes and checkpoints are made from these tables.

#include <vector>

#include "renderer/settings/option.h"

namespace gatelight::renderer {

/// In the order of the help, bound to the members of `options`, which must outlive them.
std::vector<Option> option_table(RenderOptions& options);

/// Parts of the table.
void add_cache_options(std::vector<Option>& table, CacheOptions& options);
void add_cache_file_options(std::vector<Option>& table, CacheOptions& options);

}  // namespace gatelight::renderer
