#include "apps/render/run_team.h"

#include <fmt/format.h>

#include "apps/terminal/log.h"
#include "apps/terminal/text.h"
#include "base/errors.h"
#include "renderer/film/memory_estimate.h"

namespace gatelight::apps {

void RunTeam::join(RenderSettings& settings) {
  if (settings.frames.groups == 1) return;
  throw BadOption({"frame-groups", "", "a single process has only one group",
                   "several ranks of gatelight-mpi, started with mpirun or srun"});
}

void RunTeam::check(const RenderSettings& settings, const scene::Scene& scene) const {
  log_detail(fmt::format("memory needed, estimated: {}",
                         format_bytes(renderer::estimate_memory(scene, settings.render).total())));
}

}  // namespace gatelight::apps
