#pragma once
// The film of --preview-video, made of the files of frames.

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "apps/settings/render_settings.h"

namespace gatelight::apps {

struct FilmCallbacks {
  std::function<void(std::size_t done)> progress;  ///< frames
  std::function<bool()> stop;                      ///< when it returns true, there is no film
  std::function<void(const std::string&)> warn;
};

/// Writes the film of these frames, in their order, as they are displayed: over black where they have alpha.
/// Frames whose file cannot be read, or has another size than the first one, are left out with one warning.
/// `settings`: of the whole run. Returns the number of frames in the film. Throws OutputError.
std::size_t write_film(const RenderSettings& settings, const std::vector<int>& frames,
                       const FilmCallbacks& callbacks);

}  // namespace gatelight::apps
