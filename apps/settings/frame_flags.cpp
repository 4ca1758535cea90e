#include "apps/settings/frame_flags.h"

#include <fmt/format.h>

#include "apps/terminal/errors.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {

void check_frame_groups(const RenderSettings& settings) {
  const FrameSettings& frames = settings.frames;
  if (frames.groups == 1) return;
  const renderer::RenderOptions& options = settings.render;
  const auto refuse = [](const std::string& why) { throw UsageError("--frame-groups: " + why); };
  if (!frames.range) refuse("there are no frames, expected --frames or --turntable with it");
  if (const std::size_t count = frames.range->numbers().size();
      count < static_cast<std::size_t>(frames.groups))
    refuse(fmt::format("{}, expected at most the number of frames, {}", frames.groups, count));
  if (!options.checkpoint.file.empty())
    refuse(
        "a checkpoint is of one frame after the other, expected no --checkpoint; --skip-existing leaves out "
        "those that are done");
  if (!options.choose_integrator) check_frame_groups(frames, options.integrator);
  if (options.denoise.denoiser != renderer::DenoiserKind::none && options.denoise.temporal)
    refuse("denoised frames take over light of the one before, expected --temporal off or --denoiser none");
}

void check_frame_groups(const FrameSettings& frames, renderer::Integrator integrator) {
  if (frames.groups > 1 && renderer::uses_cache(integrator))
    throw UsageError(
        fmt::format("--frame-groups: frames of a kept cache depend on the one before, and the integrator is "
                    "'{}', expected --integrator path or ao",
                    renderer::enum_name(integrator)));
}

}  // namespace gatelight::apps
