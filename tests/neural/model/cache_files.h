#pragma once
// Files of caches whose state is no learned one, and their refusals.

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/file/content_digest.h"
#include "base/file/safetensors.h"
#include "neural/model/model_file.h"
#include "neural/trainer.h"
#include "tests/support/messages.h"
#include "tests/support/model_cases.h"
#include "tests/support/stored_state.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::neural::testing {

using gatelight::tests::expect_refusal;
using gatelight::tests::NameList;
using gatelight::tests::Place;
using gatelight::tests::read_file;
using gatelight::tests::refusal;
using gatelight::tests::TemporaryFolder;

inline constexpr const char* kFingerprint = "scene 1234";

inline Trainer make_trainer(const ModelCase& c, const TrainingOptions& options, std::uint64_t seed) {
  return {c.model, options,
          std::make_unique<StoredState>(c.model, options, any_state(*c.model, options, seed))};
}

inline ModelState state_of(const Trainer& trainer) {
  return trainer.backend().export_state();
}

inline void expect_load_refused(Trainer& trainer, const std::filesystem::path& path, NameList names,
                                const std::string& fingerprint = kFingerprint,
                                Place place = Place::current()) {
  names.push_back(path.string());
  expect_refusal<CacheFileError>([&] { trainer.load(path, fingerprint); }, names, place);
}

/// Writes a file with the right digest.
inline void write_with_digest(const std::filesystem::path& path, const std::vector<TensorView>& tensors,
                              Metadata metadata) {
  metadata[kDigestKey] = content_digest(tensors, metadata);
  write_safetensors(path, tensors, metadata);
}

/// Writes the trainer's file as `edit` changes it.
inline void save_edited(const Trainer& trainer, const std::filesystem::path& path,
                        const std::function<void(ModelContent&)>& edit) {
  const ModelState state = state_of(trainer);
  ModelContent content = make_model_content(trainer.model(), {}, state);
  content.metadata.insert({{"format", "gatelight-cache"}, {"version", "2"}, {"fingerprint", kFingerprint}});
  edit(content);
  write_with_digest(path, content.tensors, content.metadata);
}

/// A model with few nodes, because tests load mutations of every byte.
inline ModelCase tiny_case() {
  ModelConfig config = default_plain_config();
  config.mlp.width = 16;
  config.mlp.hidden_layers = 1;
  config.mlp.outputs = 1;
  return make_case("tiny", config);
}

}  // namespace gatelight::neural::testing
