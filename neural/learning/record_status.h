#pragma once
// The definition of the records that training accepts, for all backends.

#include <cstddef>
#include <cstdint>

#include "neural/model/batch.h"
#include "neural/model/model.h"

namespace gatelight::neural {

enum class RecordStatus : std::uint8_t {
  accepted,
  rejected,  ///< an input that the model reads, or the target, is NaN or infinite
  unstored,  ///< the surface has no storage, or surface or triangle is out of the layout's range
};

/// Whether all inputs of the point that the model reads are finite.
bool is_finite(const Model& model, const QueryBatch& points, std::size_t point);

RecordStatus record_status(const Model& model, const TrainingBatch& batch, std::size_t record);

}  // namespace gatelight::neural
