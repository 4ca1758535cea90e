#include "neural/record_status.h"

#include <algorithm>
#include <cmath>

namespace gatelight::neural {

namespace {

template <class Vector>
bool finite(const Vector& v) {
  return std::all_of(v.begin(), v.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

RecordStatus record_status(const Model& model, const TrainingBatch& batch, std::size_t i) {
  const QueryBatch& p = batch.points;
  const std::size_t outputs = model.config.mlp.outputs;
  const bool gate = model.config.encoding == FeatureEncoding::gate;
  bool usable = finite(batch.targets.subspan(i * outputs, outputs));
  if (gate) usable = usable && finite(p.barycentrics[i]);
  if (uses_input(model.config, InputSource::position)) usable = usable && finite(p.positions[i]);
  if (uses_input(model.config, InputSource::direction)) usable = usable && finite(p.directions[i]);
  if (uses_input(model.config, InputSource::normal)) usable = usable && finite(p.normals[i]);
  if (uses_input(model.config, InputSource::albedo)) usable = usable && finite(p.albedos[i]);
  if (uses_input(model.config, InputSource::roughness)) usable = usable && std::isfinite(p.roughnesses[i]);
  if (!usable) return RecordStatus::rejected;
  if (gate) {
    const std::uint32_t surface = p.surfaces[i];
    if (surface >= model.gate.surfaces.size() ||
        p.triangles[i] >= model.gate.surfaces[surface].triangle_count ||
        model.gate.levels[std::size_t{surface} * model.gate.stack].resolution == 0)
      return RecordStatus::unstored;
  }
  return RecordStatus::accepted;
}

}  // namespace gatelight::neural
