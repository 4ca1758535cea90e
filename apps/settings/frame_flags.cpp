#include "apps/settings/frame_flags.h"

#include <fmt/format.h>

#include "apps/terminal/errors.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {

void check_frame_groups(const RenderSettings& settings) {
  const FrameSettings& frames = settings.frames;
  if (frames.groups == 1) return;
  const renderer::RenderOptions& options = settings.render;
  const auto refuse = [](const char* problem, const std::string& expected) {
    throw BadOption({"frame-groups", "", problem, expected});
  };
  if (!frames.range) refuse("there are no frames", "`frames` or `turntable` with it");
  if (const std::size_t count = frames.range->numbers().size();
      count < static_cast<std::size_t>(frames.groups))
    refuse("there are fewer frames", fmt::format("at most their number, {}", count));
  if (!options.checkpoint.file.empty())
    refuse("a checkpoint is of one frame after the other",
           "no `checkpoint`; `skip-existing` leaves out those that are done");
  if (!options.choose_integrator) check_frame_groups(frames, options.integrator);
  if (options.denoise.denoiser != renderer::DenoiserKind::none && options.denoise.temporal)
    refuse("denoised frames take over light of the one before", "`temporal` off or `denoiser` none");
}

void check_frame_groups(const FrameSettings& frames, renderer::Integrator integrator) {
  if (frames.groups > 1 && renderer::uses_cache(integrator))
    throw BadOption(
        {"frame-groups", "",
         fmt::format("frames of a kept cache depend on the one before, and the integrator is '{}'",
                     renderer::enum_name(integrator)),
         "`integrator` path or ao"});
}

}  // namespace gatelight::apps
