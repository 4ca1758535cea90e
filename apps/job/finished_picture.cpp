#include "apps/job/finished_picture.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <exception>

#include "apps/reports/recipe.h"
#include "apps/settings/picture_output.h"
#include "base/errors.h"
#include "renderer/image/auto_exposure.h"

namespace gatelight::apps {

std::vector<std::string> warnings_of(const renderer::RenderStatistics& statistics) {
  std::vector<std::string> warnings;
  if (const std::string& why = statistics.denoise_failure; !why.empty())
    warnings.push_back(fmt::format("the picture keeps its noise: {}", why));
  if (statistics.nonfinite > 0) {
    warnings.push_back(
        fmt::format("{} samples were not finite and are ignored; the statistics list the first of them",
                    statistics.nonfinite));
  }
  if (const std::uint64_t paths = statistics.rays.ended_walks; paths > 0) {
    warnings.push_back(fmt::format(
        "{} paths ended after 65536 scattering events in a body: it is too dark, because it absorbs next to "
        "nothing and is much thicker than a mean free path",
        paths));
  }
  return warnings;
}

renderer::ImageWriteOptions finish_picture(renderer::Picture& picture, const RenderSettings& settings,
                                           const renderer::RenderStatistics& statistics, double seconds,
                                           RunReport& report) {
  renderer::ImageWriteOptions image = settings.image;
  if (!settings.exposure) image.display.exposure = renderer::auto_exposure(picture);
  report.exposure = image.display.exposure;
  picture.metadata.merge(make_recipe(settings, report.command, statistics, seconds));
  return image;
}

void write_pictures(const renderer::Picture& picture, const std::vector<std::string>& outputs,
                    const renderer::ImageWriteOptions& image) {
  std::vector<std::exception_ptr> errors(outputs.size());
  tbb::parallel_for(std::size_t{0}, outputs.size(), [&](std::size_t i) {
    try {
      write_picture(picture, outputs[i], image);
    } catch (...) {
      errors[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

void require_good_end(const renderer::RenderStatistics& statistics, bool written) {
  if (const std::string& why = statistics.device_lost; !why.empty())
    throw DeviceLost(why + (written ? "; the picture so far was written" : ""));
  if (const std::string& why = statistics.cache.diverged; !why.empty()) {
    throw TrainingDiverged(written ? fmt::format("{}; the written picture is of the last good step, {}", why,
                                                 statistics.cache.steps)
                                   : why);
  }
}

}  // namespace gatelight::apps
