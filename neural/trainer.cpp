#include "neural/trainer.h"

#include <utility>

#include "base/errors.h"
#include "neural/model/checks.h"
#include "neural/model/model_file.h"

namespace gatelight::neural {

Trainer::Trainer(std::shared_ptr<const Model> model, const TrainingOptions& options,
                 std::unique_ptr<Backend> backend)
    : model_(std::move(model)), options_(options), backend_(std::move(backend)) {
  if (model_ == nullptr) throw BadConfiguration("trainer: no model");
  if (backend_ == nullptr) throw BadConfiguration("trainer: no backend");
  check_options(*model_, options_);
}

void Trainer::save(const std::filesystem::path& path, const std::string& fingerprint) const {
  write_model_file(path, *model_, options_, backend_->export_state(), fingerprint);
}

void Trainer::load(const std::filesystem::path& path, const std::string& fingerprint) {
  backend_->import_state(read_model_file(path, *model_, options_, fingerprint));
}

}  // namespace gatelight::neural
