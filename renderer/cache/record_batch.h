#pragma once
// The records of some training steps, and the interface of the sources that make them.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "neural/model/batch.h"
#include "renderer/cache/path_batch.h"
#include "renderer/cache/training_points.h"
#include "renderer/film/film_samples.h"

namespace gatelight::renderer {

struct CacheSetup;

/// Splits records into batches. Of n records at most `most` (0: all) are kept, evenly spread. They are
/// assigned to the batches round-robin, so that each batch has records from the whole picture.
class BatchSplit {
 public:
  BatchSplit() = default;
  BatchSplit(std::uint64_t n, std::uint64_t most, std::uint64_t batches)
      : n_(n), most_(most > 0 && most < n ? most : n), batches_(batches) {}
  std::uint64_t kept() const { return most_; }
  std::uint64_t batches() const { return batches_; }
  bool keeps(std::uint64_t j) const { return kept_before(j + 1) > kept_before(j); }
  /// The place of a record that is kept.
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

/// A request for the records of some training steps.
struct RecordRequest {
  std::uint64_t step = 0;          ///< first step; keys the random numbers
  bool samples = false;            ///< the points are samples of the picture
  std::uint64_t first_sample = 0;  ///< the first of them, in SampleOrder
  std::size_t points = 0;          ///< training points
  std::size_t most_records = 0;    ///< limit; excess records are left out evenly; 0: all are kept
  std::uint64_t batches = 1;       ///< one for each step
  bool self_training = false;
  bool to_the_end = false;  ///< samples of the picture may have to end nowhere: RecordBatch::traced
  float target_scale = 1.0f;
  float contribution_threshold = 0.0f;    ///< PathPlan::contribution_threshold
  std::span<const std::uint32_t> counts;  ///< training steps of each triangle with storage; may be empty
  bool counts_choice = true;              ///< whether RecordSource::rays() has those that choose the points
};

/// The start of each block in an array of the points of all blocks; the last entry is their number.
template <typename Size>
std::vector<std::size_t> offsets_of(const std::vector<PathBatch>& blocks, Size size) {
  std::vector<std::size_t> offsets(blocks.size() + 1, 0);
  for (std::size_t b = 0; b < blocks.size(); ++b) offsets[b + 1] = offsets[b] + size(blocks[b]);
  return offsets;
}

/// Records of one or more batches.
struct RecordBatch {
  TrainingStarts starts;
  PathPlan plan;  ///< of the paths
  /// First hits and radiance of starts that are the picture's samples; else empty.
  std::vector<FirstHit> first_hits;
  std::vector<Color> radiance;
  std::vector<Color> parts;      ///< those of each sample that the film keeps (LightParts); empty without
  std::vector<Color> traced;     ///< the same without an end in the cache, if RecordRequest::to_the_end
  std::vector<PathBatch> paths;  ///< one for each block of starts, with the records of the block
  SurfacePoints records;
  std::vector<float> targets;  ///< outputs for each record, times the scale of targets
  std::uint64_t paths_traced = 0;
  BatchSplit batch_split;  ///< of `records`
  /// The process that traces each block, and the number of this one (RecordExchange); empty: this one traces
  /// all.
  std::vector<int> tracers;
  int self = 0;

  neural::TrainingBatch batch(std::uint64_t m) const {
    const std::uint64_t begin = batch_split.begin(m);
    const std::uint64_t size = batch_split.begin(m + 1) - begin;
    const std::size_t outputs = records.size() == 0 ? 0 : targets.size() / records.size();
    return {records.batch(begin, size), std::span(targets).subspan(outputs * begin, outputs * size)};
  }
  /// Whether the block is traced here.
  bool mine(std::size_t block) const { return tracers.empty() || tracers[block] == self; }
  /// Adds the starts that are the picture's samples to its film, where `wanted` wants the pixel.
  void add_to(Film& film, const RenderOptions& options, const std::function<bool(const Pixel&)>& wanted,
              SampleCounts& counts) const;
};

/// The number of points that make about `records` records.
inline std::size_t points_for(double records, double records_per_point) {
  return static_cast<std::size_t>(std::max(1.0, std::ceil(records / records_per_point)));
}

/// An answer is the network's output times `scale`, at most `greatest`.
struct AnswerUnits {
  float scale = 1.0f;
  float greatest = std::numeric_limits<float>::max();
};

/// Answers in radiance over reflectance: 3 floats for each point.
struct AnswerPoints {
  std::function<void(const SurfacePoints& points, std::span<float> answers)> ask;
  bool threads = false;  ///< several may ask at a time
};

/// Makes records in parts, so that tracing can overlap with the training of the steps before: begin() and
/// trace() do not use the cache, finish() queries it. They leave out blocks that are traced elsewhere. Then
/// the caller splits the records into batches. Gives the same bits for any number of threads.
class RecordSource {
 public:
  virtual ~RecordSource() = default;
  /// A request for about `records` records, from `step` on. The caller sets most_records, batches and counts.
  /// `to_the_end`: the cache may have learned another light, so no path ends in it unasked.
  virtual RecordRequest request(const CacheSetup& setup, std::uint64_t step, std::uint64_t records,
                                bool to_the_end) const = 0;
  /// The units of answers of a cache that is trained with these records.
  virtual AnswerUnits units(const CacheSetup& setup) const = 0;
  virtual std::size_t outputs() const = 0;  ///< targets of a record
  virtual const PointInputs& inputs() const = 0;
  /// Chooses the starts of the paths, which decide the number of blocks.
  virtual void begin(const RecordRequest& request, RecordBatch& batch) = 0;
  /// Traces a block. Blocks may be traced at the same time.
  virtual void trace(RecordBatch& batch, std::size_t block) = 0;
  virtual void finish(const AnswerPoints& answer, RecordBatch& batch) = 0;
  virtual RayCounts rays() const = 0;

  /// Traces all blocks of a batch that was begun.
  void trace(RecordBatch& batch);

  /// Splits the records of all blocks into batches, with outputs() targets each, times the request's scale.
  void split(const RecordRequest& request, RecordBatch& batch) const;
};

}  // namespace gatelight::renderer
