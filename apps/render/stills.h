#pragma once
// The still pictures of one call of `gatelight render`: one for each camera that is asked for.

#include "apps/render/picture_maker.h"

namespace gatelight::apps {

/// Says that a signal came before the first pass. Returns the exit code.
int note_signal_before_picture(Console& console, int signal, const std::string& scene);

/// `start`: from where the seconds of the first picture count. Returns the exit code.
int render_stills(const RenderSettings& settings, const scene::Scene& scene, PictureMaker& maker,
                  Clock::time_point start);

}  // namespace gatelight::apps
