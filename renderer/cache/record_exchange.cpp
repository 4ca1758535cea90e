#include "renderer/cache/record_exchange.h"

#include <algorithm>
#include <utility>

#include "renderer/cache/record_batch.h"
#include "renderer/distributed/packing.h"

namespace gatelight::renderer {
namespace {

/// The parts of a sample of the picture.
template <class Batch>
auto parts_of(Batch& batch, std::size_t sample) {
  const std::size_t count = batch.parts.size() / batch.starts.samples.size();
  return std::span(batch.parts).subspan(sample * count, count);
}

/// Work of the slowest process after which the shares are adjusted.
constexpr double kRebalanceSeconds = 0.5;

Bytes pack_records(const RecordBatch& batch, const SharedTiles& all, const RankWork& work) {
  Packer packer;
  packer.add(work);
  for (std::size_t b = 0; b < batch.paths.size(); ++b) {
    if (!batch.mine(b)) continue;
    const PathBatch& paths = batch.paths[b];
    packer.add(static_cast<std::uint32_t>(paths.records.size()));
    packer.add(static_cast<std::uint32_t>(paths.targets.size()));
    paths.records.pack(packer);
    packer.add_all(std::span(paths.targets));
  }
  if (batch.starts.samples.empty()) return packer.take();
  for (std::size_t b = 0; b < batch.paths.size(); ++b) {
    if (!batch.mine(b)) continue;
    for (std::size_t i = batch.starts.offsets[b]; i < batch.starts.offsets[b + 1]; ++i) {
      if (all.owns(batch.starts.samples[i].pixel)) continue;
      packer.add(static_cast<std::uint64_t>(i));
      packer.add(batch.radiance[i]);
      if (!batch.traced.empty()) packer.add(batch.traced[i]);
      packer.add(batch.first_hits[i]);
      packer.add_all(parts_of(batch, i));
    }
  }
  return packer.take();
}

/// Returns the work of each process.
std::vector<RankWork> unpack_records(const std::vector<Bytes>& records, const SharedTiles& all,
                                     RecordBatch& batch) {
  std::vector<RankWork> work;
  for (std::size_t r = 0; r < records.size(); ++r) {
    Unpacker unpacker(records[r]);
    work.push_back(unpacker.read<RankWork>());
    if (static_cast<int>(r) == all.ranks.rank()) continue;
    for (std::size_t b = 0; b < batch.paths.size(); ++b) {
      if (batch.tracers[b] != static_cast<int>(r)) continue;
      PathBatch& paths = batch.paths[b];
      const auto count = unpacker.read<std::uint32_t>();
      paths.targets.resize(unpacker.read<std::uint32_t>());
      paths.records.unpack(unpacker, count);
      unpacker.read_all(std::span(paths.targets));
    }
    while (!unpacker.done()) {
      const auto i = static_cast<std::size_t>(unpacker.read<std::uint64_t>());
      const auto radiance = unpacker.read<Color>();
      const auto traced = batch.traced.empty() ? radiance : unpacker.read<Color>();
      const auto first = unpacker.read<FirstHit>();
      std::vector<Color> parts(parts_of(batch, i).size());
      unpacker.read_all(std::span(parts));
      if (!all.owns(batch.starts.samples[i].pixel)) continue;
      batch.radiance[i] = radiance;
      if (!batch.traced.empty()) batch.traced[i] = traced;
      batch.first_hits[i] = first;
      std::copy(parts.begin(), parts.end(), parts_of(batch, i).begin());
    }
  }
  return work;
}

}  // namespace

void RecordExchange::choose_blocks(RecordBatch& batch) const {
  if (is_alone()) return;
  const TrainingStarts& starts = batch.starts;
  const std::size_t blocks = starts.blocks();
  batch.tracers.clear();
  batch.self = all_->ranks.rank();
  const std::int64_t tiles = all_->tiles.count();
  for (std::size_t b = 0; b < blocks; ++b) {
    batch.tracers.push_back(starts.samples.empty()
                                ? all_->shares.owner(static_cast<int>(static_cast<std::int64_t>(b) * tiles /
                                                                      static_cast<std::int64_t>(blocks)))
                                : all_->owner(starts.samples[starts.offsets[b]].pixel));
  }
}

RecordExchange::Coming RecordExchange::send(const RecordBatch& batch, const RankWork& work) {
  if (is_alone()) return nullptr;
  Bytes packed = pack_records(batch, *all_, work);
  share.bytes += packed.size();
  return all_->ranks.begin_gather(std::move(packed));
}

void RecordExchange::receive(Coming coming, RecordBatch& batch) {
  if (is_alone()) return;
  const TrainingStarts& starts = batch.starts;
  for (std::size_t b = 0; b < starts.blocks(); ++b) {
    if (batch.mine(b)) share.paths += starts.offsets[b + 1] - starts.offsets[b];
  }
  const std::vector<RankWork> work = unpack_records(coming->wait(), *all_, batch);
  work_.resize(work.size());
  for (std::size_t r = 0; r < work.size(); ++r) {
    work_[r].seconds += work[r].seconds;
    work_[r].rays += work[r].rays;
  }
}

void RecordExchange::rebalance(const Rebalance& use) {
  const auto longer = [](const RankWork& a, const RankWork& b) { return a.seconds < b.seconds; };
  const auto longest = std::max_element(work_.begin(), work_.end(), longer);
  if (!use || longest == work_.end() || longest->seconds < kRebalanceSeconds) return;
  use(work_);
  work_.clear();
}

}  // namespace gatelight::renderer
