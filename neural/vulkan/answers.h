#pragma once
// Answers queries in chunks. The caller packs a chunk while the device computes earlier ones.

#include <optional>
#include <vector>

#include "neural/model/backend.h"
#include "neural/vulkan/feature_store.h"
#include "neural/vulkan/machine.h"
#include "neural/vulkan/network_store.h"
#include "neural/vulkan/submission.h"

namespace gatelight::neural::vulkan {

/// How a workgroup of answer.comp uses shared memory.
struct AnswerTile {
  std::uint32_t points = 4;
  std::uint32_t staged_vectors = 1;  ///< weights in vectors of four; 1: they do not fit
};
AnswerTile answer_tile(const Model& model, std::uint32_t shared_bytes);

class Answers {
 public:
  /// The arguments must outlive the object.
  Answers(Machine& machine, const Model& model, const FeatureStore& features, const NetworkStore& network);

  /// `model` is the address of the model's block.
  void run(Address model, const QueryBatch& batch, const QueryOptions& options, std::span<float> out);
  /// Waits for the chunks of a query that an exception ended.
  void abandon();
  /// Must be called after each change of the network's parameters.
  void parameters_changed() { packed_.reset(); }

 private:
  /// The kind of packed weights in NetworkStore::query_forward.
  struct PackedFor {
    bool averaged = false, rounded = false;
    friend bool operator==(const PackedFor&, const PackedFor&) = default;
  };

  void submit(Submission& chunk, Address model, const QueryBatch& batch, const QueryOptions& options,
              std::size_t begin);
  void read_results(Submission& chunk, std::size_t begin, std::span<float> out);
  Address packed_for(const QueryOptions& options, std::optional<PackedFor>& to_pack) const;

  Machine& machine_;
  const Model& model_;
  const FeatureStore& features_;
  const NetworkStore& network_;
  AnswerTile tile_;
  std::vector<Submission> chunks_;
  std::optional<PackedFor> packed_;
};

}  // namespace gatelight::neural::vulkan
