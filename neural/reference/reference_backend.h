#pragma once
// The same mathematics in double precision, one record after the other, written to be read beside the paper.
// The oracle for every kernel.

#include <memory>

#include "neural/model/backend.h"

namespace gatelight::neural::reference {

/// State is kept in double and exported as float. bf16 queries are answered in double. Not fast, not
/// parallel.
std::unique_ptr<Backend> make_reference_backend(std::shared_ptr<const Model> model,
                                                const TrainingOptions& options);

}  // namespace gatelight::neural::reference
