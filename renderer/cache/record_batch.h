#pragma once
// The records of one training step in the making, and those who make them.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "neural/batch.h"
#include "renderer/cache/path_batch.h"
#include "renderer/cache/training_points.h"

namespace gatelight::renderer {

struct RecordBatch {
  std::uint64_t step = 0;
  TrainingStarts starts;
  std::vector<PathBatch> paths;  ///< one for each block of starts
  SurfacePoints queries;         ///< of all blocks: where paths ended in the cache
  std::vector<float> answers;
  SurfacePoints records;
  std::vector<float> targets;  ///< outputs for each record, times the scale of targets
  std::uint64_t paths_traced = 0;
  std::uint64_t records_made = 0;  ///< before those beyond the batch's size were left out

  neural::TrainingBatch batch() const { return {records.batch(), targets}; }
};

/// What a step of training needs of its records.
struct RecordRequest {
  std::uint64_t step = 0;
  std::size_t points = 0;        ///< training points
  std::size_t most_records = 0;  ///< more are thinned out evenly; 0: all are kept
  bool self_training = false;
  float target_scale = 1.0f;
  std::span<const std::uint32_t> counts;  ///< of training, for each triangle with storage; may be empty
};

/// Which of n records are kept where there may be `most` (0: all), evenly spread.
class Thinning {
 public:
  Thinning(std::uint64_t n, std::uint64_t most) : n_(n), most_(most > 0 && most < n ? most : n) {}
  std::uint64_t kept() const { return most_; }
  /// Of records 0 to j-1: the place of record j, where it is kept.
  std::uint64_t kept_before(std::uint64_t j) const { return n_ == 0 ? 0 : j * most_ / n_; }
  bool keeps(std::uint64_t j) const { return kept_before(j + 1) > kept_before(j); }

 private:
  std::uint64_t n_;
  std::uint64_t most_;
};

/// Answers in radiance over reflectance: 3 floats for each point.
using AnswerPoints = std::function<void(const SurfacePoints& points, std::span<float> answers)>;

/// Makes records in two parts, so that tracing can go on while the step before is learned: trace() needs
/// nothing of the cache, finish() asks it. The same bits for any number of threads.
class RecordSource {
 public:
  virtual ~RecordSource() = default;
  virtual void trace(const RecordRequest& request, RecordBatch& batch) = 0;
  virtual void finish(const RecordRequest& request, const AnswerPoints& answer, RecordBatch& batch) = 0;
  virtual RayCounts rays() const = 0;
};

}  // namespace gatelight::renderer
