#pragma once
// The backend in double precision. It processes one record after the other, follows the equations of the
// paper, and is the reference for all kernels.

#include <memory>

#include "neural/model/backend.h"

namespace gatelight::neural::reference {

/// Keeps the state in double and exports it as float. Answers bf16 queries in double. It is slow and not
/// parallel.
std::unique_ptr<Backend> make_reference_backend(std::shared_ptr<const Model> model,
                                                const TrainingOptions& options);

}  // namespace gatelight::neural::reference
