#pragma once
// The cache file: a model's state as safetensors, with what it belongs to in the metadata. The README lists
// tensors and metadata.

#include <cstdint>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "neural/file/safetensors.h"
#include "neural/model/state.h"

namespace gatelight::neural {

/// A model's part of a file that may hold more: its tensors, and metadata `network`, `layout`,
/// `layout_digest`, `arrays` and `training`. The views point into the state that it was made from.
struct ModelContent {
  std::vector<TensorView> tensors;
  Metadata metadata;
  std::vector<std::uint16_t> halves;  ///< fp16 features, which the state holds as floats

  ModelContent() = default;
  ModelContent(ModelContent&&) = default;
  ModelContent& operator=(ModelContent&&) = default;
};

/// Throws BadConfiguration for a state that is not the model's.
ModelContent make_model_content(const Model& model, const TrainingOptions& options, const ModelState& state);

/// The model's part of a file. Throws CacheFileError, naming the difference, unless it is sound and of this
/// model and layout, and was trained under options that keep the same arrays. Learning rates, loss and seed
/// may differ.
ModelState read_model_content(SafetensorsReader& file, const Model& model, const TrainingOptions& options);

/// Throws CacheFileError unless the metadata holds this text under `key`; `what` is its name in the message.
void expect_text(const SafetensorsReader& file, const std::string& key, const std::string& what,
                 const std::string& expected);
/// Throws CacheFileError unless the version is this one and the digest is right, or it is the one before,
/// which had no digest yet.
void expect_version(SafetensorsReader& file, int version);
/// Throws CacheFileError, naming the difference, where read_model_content would refuse the file for its
/// model, its options, or the type or shape of a tensor. Reads no tensor: a model that is made after a file
/// takes memory only when the file has the bytes for it.
void expect_model(const SafetensorsReader& file, const Model& model, const TrainingOptions& options);
/// Throws CacheFileError where the file holds a tensor that is neither of the model nor one of `others`.
void expect_no_other_tensors(const SafetensorsReader& file, const Model& model,
                             const TrainingOptions& options, std::set<std::string> others = {});

/// Throws CacheFileError, and BadConfiguration for a state that is not the model's.
void write_model_file(const std::filesystem::path& path, const Model& model, const TrainingOptions& options,
                      const ModelState& state, const std::string& fingerprint);

/// Throws CacheFileError as read_model_content does, and where the file is of another fingerprint or holds
/// more.
ModelState read_model_file(const std::filesystem::path& path, const Model& model,
                           const TrainingOptions& options, const std::string& fingerprint);

}  // namespace gatelight::neural
