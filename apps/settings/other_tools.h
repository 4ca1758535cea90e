#pragma once
// Words that users of other renderers may type.

#include <string>
#include <string_view>

namespace gatelight::apps {

/// What a flag of pbrt, Blender or Mitsuba is here: "--spp N" for "samples" or "-s"; empty for other words.
/// `flag`: with its dashes, without a value.
std::string flag_of_other_tools(std::string_view flag);

}  // namespace gatelight::apps
