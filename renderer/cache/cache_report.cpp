#include "renderer/cache/cache_report.h"

#include "renderer/errors.h"

namespace gatelight::renderer {

CacheReport report_cache(const scene::Scene&, const RenderOptions&) {
  throw BadOption("what the cache of a scene would be is not told yet");
}

}  // namespace gatelight::renderer
