#pragma once
// The interface for applications: a model, its options and its backend.

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
  void start(std::span<const TrainingBatch> batches, Team* team = nullptr) { backend_->start(batches, team); }
  StepStatistics finish() { return backend_->finish(); }
  void query(const QueryBatch& batch, const QueryOptions& options, std::span<float> out) const {
    backend_->query(batch, options, out);
  }

  /// Writes the whole state and configuration to a .safetensors file (an AtomicFile). `fingerprint`
  /// identifies what was learned; it is any text, for example a hash of the scene. Throws OutputError.
  void save(const std::filesystem::path& path, const std::string& fingerprint) const;
  /// Throws CacheFileError, which names the difference, for a damaged file or another configuration, layout,
  /// version or fingerprint. In that case, the trainer is unchanged.
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
