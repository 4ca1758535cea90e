#pragma once
// What follows a picture that is rendered, for every way to ask for one.

#include "apps/reports/run_report.h"
#include "apps/settings/render_settings.h"
#include "renderer/image/image_write.h"
#include "renderer/image/picture.h"
#include "renderer/settings/statistics.h"

namespace gatelight::apps {

/// What the statistics of a picture say to its user.
std::vector<std::string> warnings_of(const renderer::RenderStatistics& statistics);

/// Chooses the exposure where the settings leave it open, and adds the recipe to the metadata. Returns how
/// the picture is shown and written; the report has the exposure.
renderer::ImageWriteOptions finish_picture(renderer::Picture& picture, const RenderSettings& settings,
                                           const renderer::RenderStatistics& statistics, double seconds,
                                           RunReport& report);

/// Writes all outputs, side by side; after that, throws the first error, so that a full disk does not cost
/// the other files.
void write_pictures(const renderer::Picture& picture, const std::vector<std::string>& outputs,
                    const renderer::ImageWriteOptions& image);

/// Throws DeviceLost or TrainingDiverged for a picture that ended so. `written`: its files hold what there
/// is.
void require_good_end(const renderer::RenderStatistics& statistics, bool written);

}  // namespace gatelight::apps
