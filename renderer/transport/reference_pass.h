#pragma once
// Passes of the integrators without a cache. Each sample of a tile is one batch.

#include "renderer/transport/ao_integrator.h"
#include "renderer/transport/pass.h"
#include "renderer/transport/path_integrator.h"

namespace gatelight::renderer {

struct ReferenceWorker {
  std::vector<Pixel> pixels;
  std::vector<PixelSample> taken;
  std::vector<CameraSample> samples;
  std::vector<SampleResult> results;
  std::vector<FirstHit> first_hits;
  PathIntegrator::Scratch path;
  AoIntegrator::Scratch ao;
  RayCounts rays;
  SampleCounts counts;
};

class ReferencePass : public WorkerPass<ReferenceWorker> {
 public:
  /// options.integrator is path or ao.
  ReferencePass(const World& world, const PassContext& context);

  void run(int samples, Film& film, const std::function<void(double)>& report) override;

 private:
  PassContext context_;
  PathIntegrator path_;
  AoIntegrator ao_;
};

}  // namespace gatelight::renderer
