#pragma once
// The records of a few training steps in the making, and those who make them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "neural/base/batch.h"
#include "renderer/cache/path_batch.h"
#include "renderer/cache/training_points.h"

namespace gatelight::renderer {

struct CacheSetup;

/// Where the records of several batches lie, and which are kept: of n records at most `most` (0: all), evenly
/// spread, are dealt to the batches in turn, so that each batch has records from the whole picture.
class Dealing {
 public:
  Dealing() = default;
  Dealing(std::uint64_t n, std::uint64_t most, std::uint64_t batches)
      : n_(n), most_(most > 0 && most < n ? most : n), batches_(batches) {}
  std::uint64_t kept() const { return most_; }
  std::uint64_t batches() const { return batches_; }
  bool keeps(std::uint64_t j) const { return kept_before(j + 1) > kept_before(j); }
  /// Of a record that is kept.
  std::uint64_t place(std::uint64_t j) const {
    const std::uint64_t k = kept_before(j);
    return begin(k % batches_) + k / batches_;
  }
  /// First place of batch m. begin(batches()) is kept().
  std::uint64_t begin(std::uint64_t m) const {
    return m * (most_ / batches_) + std::min(m, most_ % batches_);
  }

 private:
  std::uint64_t kept_before(std::uint64_t j) const { return n_ == 0 ? 0 : j * most_ / n_; }

  std::uint64_t n_ = 0;
  std::uint64_t most_ = 0;
  std::uint64_t batches_ = 1;
};

/// What some steps of training need of their records.
struct RecordRequest {
  std::uint64_t step = 0;        ///< the first one: keys the random numbers
  std::size_t points = 0;        ///< training points
  std::size_t most_records = 0;  ///< more are thinned out evenly; 0: all are kept
  std::uint64_t batches = 1;     ///< one for each step
  bool self_training = false;
  float target_scale = 1.0f;
  std::span<const std::uint32_t> counts;  ///< of training, for each triangle with storage; may be empty
};

/// Where the points of each block begin in an array of all, and their number at the end.
template <typename Size>
std::vector<std::size_t> offsets_of(const std::vector<PathBatch>& blocks, Size size) {
  std::vector<std::size_t> offsets(blocks.size() + 1, 0);
  for (std::size_t b = 0; b < blocks.size(); ++b) offsets[b + 1] = offsets[b] + size(blocks[b]);
  return offsets;
}

/// Records of one or more batches.
struct RecordBatch {
  TrainingStarts starts;
  std::vector<PathBatch> paths;  ///< one for each block of starts, with its records
  SurfacePoints queries;         ///< of all blocks: where paths ended in the cache
  std::vector<float> answers;
  SurfacePoints records;
  std::vector<float> targets;  ///< outputs for each record, times the scale of targets
  std::uint64_t paths_traced = 0;
  Dealing dealing;  ///< of `records`

  neural::TrainingBatch batch(std::uint64_t m) const {
    const std::uint64_t begin = dealing.begin(m);
    const std::uint64_t size = dealing.begin(m + 1) - begin;
    const std::size_t outputs = records.size() == 0 ? 0 : targets.size() / records.size();
    return {records.batch(begin, size), std::span(targets).subspan(outputs * begin, outputs * size)};
  }
  /// Deals the records of all `paths` to the batches, with so many targets for each, times the request's
  /// scale.
  void deal(const RecordRequest& request, const PointInputs& inputs, std::size_t outputs);
};

/// The number of points that leave about so many records.
inline std::size_t points_for(double records, double records_per_point) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(records / records_per_point)));
}

/// An answer is the network's output times `scale`, at most `greatest`.
struct AnswerUnits {
  float scale = 1.0f;
  float greatest = std::numeric_limits<float>::max();
};

/// Answers in radiance over reflectance: 3 floats for each point.
using AnswerPoints = std::function<void(const SurfacePoints& points, std::span<float> answers)>;

/// Makes records in two parts, so that tracing can go on while the step before is learned: trace() needs
/// nothing of the cache, finish() asks it. The same bits for any number of threads.
class RecordSource {
 public:
  virtual ~RecordSource() = default;
  /// Asks for about `records` records, from `step` on. The caller fills in most_records, batches and counts.
  virtual RecordRequest request(const CacheSetup& setup, std::uint64_t step, std::uint64_t records) const = 0;
  /// The units of the answers that a cache of these records gives.
  virtual AnswerUnits units(const CacheSetup& setup) const = 0;
  virtual void trace(const RecordRequest& request, RecordBatch& batch) = 0;
  virtual void finish(const RecordRequest& request, const AnswerPoints& answer, RecordBatch& batch) = 0;
  virtual RayCounts rays() const = 0;
};

}  // namespace gatelight::renderer
