#include "renderer/render.h"

#include <utility>

#include "neural/base/flush_denormals.h"
#include "renderer/cache/cache_report.h"
#include "renderer/run/implementation.h"

namespace gatelight::renderer {

Renderer::Renderer(const scene::Scene& scene, const RenderOptions& options)
    : implementation_(std::make_unique<Implementation>(scene, options)) {}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;

const RenderStatistics& Renderer::statistics() const {
  return implementation_->statistics;
}

CacheReport Renderer::report_cache() {
  const neural::FlushDenormals flush;
  Implementation& self = *implementation_;
  CacheReport report;
  self.arena.execute(
      [&] { report = renderer::report_cache(*self.world, self.camera, self.region, self.options); });
  RenderStatistics statistics = self.statistics;
  statistics.cache = std::move(report.statistics.cache);
  report.statistics = std::move(statistics);
  return report;
}

CacheStatistics Renderer::set_up_cache() {
  const neural::FlushDenormals flush;
  Implementation& self = *implementation_;
  CacheStatistics statistics;
  self.arena.execute(
      [&] { statistics = CacheSession(*self.world, self.camera, self.region, self.options).statistics(); });
  return statistics;
}

}  // namespace gatelight::renderer
