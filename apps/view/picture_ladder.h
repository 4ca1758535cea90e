#pragma once
// The pictures that a window shows after each change: each has more samples than the one before.

#include <cstdint>

#include "renderer/settings/options.h"

namespace gatelight::apps {

enum class Stage : std::uint8_t {
  none,
  draft,    ///< small, one sample a pixel, answered by the kept cache
  preview,  ///< of the whole size, answered by the kept cache
  refined,  ///< the same with more samples
  final,    ///< the picture of `gatelight render` with the same flags
};

/// The options of a stage, for those of the final picture. Drafts and previews are frames that share a cache
/// and their light; a draft trains it only where there is `new_light`. `divisor`: of a draft's width and
/// height. The layers that the page reads come in addition.
renderer::RenderOptions options_of_stage(Stage stage, const renderer::RenderOptions& final, bool new_light,
                                         double divisor);

/// The next draft's divisor, after one that took this long: smaller drafts keep a drag smooth.
double next_divisor(double divisor, double seconds);

}  // namespace gatelight::apps
