#include "neural/learning/record_status.h"

#include <algorithm>
#include <cmath>

namespace gatelight::neural {

namespace {

template <class Vector>
bool finite(const Vector& v) {
  return std::all_of(v.begin(), v.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

bool is_finite(const Model& model, const QueryBatch& p, std::size_t i) {
  const ModelConfig& config = model.config;
  const auto usable = [&](InputSource source, const auto& span) {
    return !uses_input(config, source) || finite(span[i]);
  };
  if (config.encoding == FeatureEncoding::gate && !finite(p.barycentrics[i])) return false;
  if (uses_input(config, InputSource::roughness) && !std::isfinite(p.roughnesses[i])) return false;
  return usable(InputSource::position, p.positions) && usable(InputSource::direction, p.directions) &&
         usable(InputSource::normal, p.normals) && usable(InputSource::albedo, p.albedos);
}

RecordStatus record_status(const Model& model, const TrainingBatch& batch, std::size_t i) {
  const QueryBatch& p = batch.points;
  const std::size_t outputs = model.config.mlp.outputs;
  if (!is_finite(model, p, i) || !finite(batch.targets.subspan(i * outputs, outputs)))
    return RecordStatus::rejected;
  if (model.config.encoding == FeatureEncoding::gate) {
    const std::uint32_t surface = p.surfaces[i];
    if (surface >= model.gate.surfaces.size() ||
        p.triangles[i] >= model.gate.surfaces[surface].triangle_count ||
        model.gate.levels[std::size_t{surface} * model.gate.stack].resolution == 0)
      return RecordStatus::unstored;
  }
  return RecordStatus::accepted;
}

}  // namespace gatelight::neural
