#pragma once
// The report of `gatelight info PICTURE.exr`: size, layers, and the recipe in its header.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "renderer/image/picture.h"

namespace gatelight::apps {

/// Lines, each with its line break: a row for each entry of the recipe, and for each option.
std::string picture_report_text(const std::string& file, const renderer::Picture& picture);
nlohmann::ordered_json picture_report_json(const std::string& file, const renderer::Picture& picture);

/// The command line that made the picture, as one line for a shell. Throws InputError where the header has
/// none.
std::string picture_command(const std::string& file, const renderer::Picture& picture);

/// Throws InputError for a picture without a recipe.
void require_recipe(const std::string& file, const renderer::Picture& picture);

}  // namespace gatelight::apps
