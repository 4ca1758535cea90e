#pragma once
// The cache file: a model's state as safetensors, with what it belongs to in the metadata. The README lists
// tensors and metadata.

#include <filesystem>
#include <string>

#include "neural/state.h"

namespace gatelight::neural {

/// Throws CacheFileError, and BadConfiguration for a state that is not the model's.
void write_model_file(const std::filesystem::path& path, const Model& model, const TrainingOptions& options,
                      const ModelState& state, const std::string& fingerprint);

/// Throws CacheFileError, naming the difference, unless the file is sound and of this model, layout and
/// fingerprint, and was trained under options that keep the same arrays. Learning rates, loss and seed may
/// differ.
ModelState read_model_file(const std::filesystem::path& path, const Model& model,
                           const TrainingOptions& options, const std::string& fingerprint);

}  // namespace gatelight::neural
