#pragma once
// The cache file: a model's state as safetensors, with a description of the model in the metadata. The README
// lists tensors and metadata.

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "base/file/safetensors.h"
#include "neural/model/state.h"

namespace gatelight::neural {

/// A model's part of a file: its tensors, and the metadata `network`, `layout`, `layout_digest`, `arrays` and
/// `training`. The views point into the state, which must outlive this object.
struct ModelContent {
  std::vector<TensorView> tensors;
  Metadata metadata;
  std::vector<std::uint16_t> halves;  ///< features converted to fp16

  ModelContent() = default;
  ModelContent(ModelContent&&) = default;
  ModelContent& operator=(ModelContent&&) = default;
};

/// Throws BadConfiguration for a state of another model.
ModelContent make_model_content(const Model& model, const TrainingOptions& options, const ModelState& state);

/// Reads the model's part of a file. Throws CacheFileError, which names the difference, unless the content is
/// valid, belongs to this model and layout, and was trained with options that keep the same arrays. Learning
/// rates, loss and seed may differ.
ModelState read_model_content(SafetensorsReader& file, const Model& model, const TrainingOptions& options);

/// Throws CacheFileError unless the metadata has the text `expected` under `key`; `what` names it in the
/// message.
void expect_text(const SafetensorsReader& file, const std::string& key, const std::string& what,
                 const std::string& expected);
/// Throws CacheFileError unless the file has this version and the right digest.
void expect_version(SafetensorsReader& file, int version);
/// Throws CacheFileError if read_model_content would refuse the file because of its model, its options, or
/// the type or shape of a tensor. It reads no tensor, so it can run before memory for the state is allocated.
void expect_model(const SafetensorsReader& file, const Model& model, const TrainingOptions& options);
/// Throws CacheFileError if the file has a tensor that is neither the model's nor one of `others`.
void expect_no_other_tensors(const SafetensorsReader& file, const Model& model,
                             const TrainingOptions& options, std::set<std::string> others = {});

/// Writes a file. Throws OutputError, and BadConfiguration for a state of another model.
void write_model_file(const std::filesystem::path& path, const Model& model, const TrainingOptions& options,
                      const ModelState& state, const std::string& fingerprint);

/// Reads a file. Throws CacheFileError as read_model_content does, and for another fingerprint or additional
/// tensors.
ModelState read_model_file(const std::filesystem::path& path, const Model& model,
                           const TrainingOptions& options, const std::string& fingerprint);

}  // namespace gatelight::neural
