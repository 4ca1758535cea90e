#include "apps/settings/frame_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "apps/settings/picture_output.h"
#include "apps/terminal/errors.h"
#include "renderer/settings/enum_names.h"

namespace gatelight::apps {

using renderer::ImageFormat;

std::string_view film_format(const std::string& file) {
  constexpr std::pair<std::string_view, std::string_view> kFormats[] = {
      {".mp4", "mp4"}, {".mkv", "matroska"}, {".mov", "mov"}, {".webm", "webm"}, {".gif", "gif"}};
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [name, format] : kFormats) {
    if (name == extension) return format;
  }
  return "";
}

std::string film_source(const std::vector<std::string>& outputs) {
  const std::vector<std::string> files = files_of(outputs);
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::exr, ImageFormat::hdr}) {
    const auto found = std::find_if(files.begin(), files.end(),
                                    [&](const std::string& file) { return output_format(file) == format; });
    if (found != files.end()) return *found;
  }
  return "";
}

void check_film(const RenderSettings& settings) {
  const std::string& film = settings.frames.film;
  if (film.empty()) return;
  if (!settings.frames.range)
    throw UsageError("--preview-video: there are no frames, expected --frames or --turntable with it");
  if (film_format(film).empty())
    throw UsageError(fmt::format(
        "--preview-video: '{}', expected a name that ends in .mp4, .mkv, .mov, .webm or .gif", film));
  if (has_frame_place(film))
    throw UsageError(fmt::format(
        "--preview-video: '{}' has the place of a frame's number, expected one file for all frames", film));
  if (film_source(settings.outputs).empty())
    throw UsageError(
        "--preview-video: the film is made of the frames' files, expected an --output in PNG, EXR or HDR");
}

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
