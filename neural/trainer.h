#pragma once
// A model, its options and the backend that learns: what an application holds.

#include <filesystem>
#include <memory>
#include <string>

#include "neural/model/backend.h"

namespace gatelight::neural {

class Trainer {
 public:
  Trainer(std::shared_ptr<const Model> model, const TrainingOptions& options,
          std::unique_ptr<Backend> backend);

  StepStatistics train(const TrainingBatch& batch) { return backend_->train(batch); }
  void start(const TrainingBatch& batch) { backend_->start(batch); }
  StepStatistics finish() { return backend_->finish(); }
  void query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const {
    backend_->query(batch, options, out);
  }

  /// A .safetensors file of the whole state, configuration and `fingerprint` of what it was trained on (any
  /// text, for example a hash of the scene). Written under a temporary name and renamed. Throws
  /// CacheFileError.
  void save(const std::filesystem::path& path, const std::string& fingerprint) const;
  /// Throws CacheFileError, naming the difference, when the file is broken or of another configuration,
  /// layout, version or fingerprint; the trainer is then unchanged.
  void load(const std::filesystem::path& path, const std::string& fingerprint);

  const Model& model() const { return *model_; }
  const TrainingOptions& options() const { return options_; }
  Backend& backend() { return *backend_; }
  const Backend& backend() const { return *backend_; }

 private:
  std::shared_ptr<const Model> model_;
  TrainingOptions options_;
  std::unique_ptr<Backend> backend_;
};

}  // namespace gatelight::neural
