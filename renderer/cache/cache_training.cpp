// The training of a CacheSession.

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "base/clock.h"
#include "base/parallel/schedule.h"
#include "renderer/cache/cache_query.h"
#include "renderer/cache/cache_session.h"
#include "renderer/cache/record_exchange.h"
#include "renderer/distributed/collectives.h"

namespace gatelight::renderer {
namespace {

/// The reported loss is the mean over this many last steps.
constexpr std::size_t kLossWindow = 64;

/// Records whose paths are traced together. Paths of several batches are more coherent, and threads wait less
/// often (5 to 10 % faster than single batches of 16384).
constexpr std::uint64_t kTracedRecords = 1 << 16;

/// Work of the slowest rank after which the shares of the ranks are adjusted.
constexpr double kRebalanceSeconds = 0.5;

}  // namespace

/// Groups grow in powers of two, so that every power of two ends a group.
std::uint64_t CacheSession::group_end(std::uint64_t step) const {
  const std::uint64_t paths =
      std::uint64_t{options_.cache.batch} * static_cast<std::uint64_t>(options_.cache.samples_per_point);
  const std::uint64_t most = std::bit_floor(std::max<std::uint64_t>(kTracedRecords / paths, 1));
  const std::uint64_t size = std::min(most, std::bit_floor(std::max<std::uint64_t>(step, 1)));
  return (step / size + 1) * size;
}

std::uint64_t CacheSession::last_group_end(std::uint64_t steps) const {
  std::uint64_t last = steps_;
  while (last < steps && group_end(last) <= steps) last = group_end(last);
  return last;
}

RecordRequest CacheSession::request(std::uint64_t step, std::uint64_t count,
                                    std::uint64_t first_sample) const {
  const std::uint64_t records = options_.cache.batch * count;
  RecordRequest request = records_->request(setup_, step, records);
  request.most_records = records;
  request.batches = count;
  request.first_sample = first_sample;
  request.ranks = ranks_;
  if (options_.cache.candidates > 1) request.counts = counts_.values();
  return request;
}

void CacheSession::learn(const RecordBatch& group, std::uint64_t batch) {
  const schedule::Section section("step");
  const Clock::time_point begin = Clock::now();
  trainer_->start(group.batch(batch));
  statistics_.train_step_seconds += seconds_since(begin);
  ++steps_;
  ++steps_under_way_;
  statistics_.steps += 1;
  if (!trainer_->backend().runs_alongside()) synchronize();
}

void CacheSession::synchronize() {
  const Clock::time_point begin = Clock::now();
  while (steps_under_way_ > 0) {
    const neural::StepStatistics step = trainer_->finish();
    const std::uint64_t number = steps_ - --steps_under_way_;
    statistics_.records += step.records;
    statistics_.rejected += step.rejected;
    statistics_.unstored += step.unstored;
    statistics_.touched_nodes = step.touched_nodes;
    last_losses_.push_back(step.loss);
    if (last_losses_.size() > kLossWindow) last_losses_.erase(last_losses_.begin());
    statistics_.loss = std::accumulate(last_losses_.begin(), last_losses_.end(), 0.0) /
                       static_cast<double>(last_losses_.size());
    guard_.look_at_loss(step, number);
  }
  statistics_.train_step_seconds += seconds_since(begin);
}

void CacheSession::look_at_answers(const RecordBatch& group) {
  const std::size_t some = std::min(TrainingGuard::kLookedAt, group.records.size());
  guard_.look_at_answers(group.targets, group.records.batch(0, some), *trainer_, steps_);
}

void CacheSession::trace(std::uint64_t step, std::uint64_t count, std::uint64_t first_sample, Group& group) {
  const schedule::Section section("trace");
  const Clock::time_point begin = Clock::now();
  const RayCounts before = records_->rays();
  group.request = request(step, count, first_sample);
  records_->trace(group.request, group.records);
  RayCounts rays = records_->rays();
  rays.subtract(before);
  group.rays = rays;
  unlearned_rays_.add(rays);
  group.work = {seconds_since(begin), rays.camera + rays.bounce + rays.shadow};
  statistics_.train_trace_seconds += group.work.seconds;
}

void CacheSession::finish(Group& group) {
  double answered = 0.0;
  const AnswerPoints answer_tail = [&](const SurfacePoints& points, std::span<float> answers) {
    const Clock::time_point begin = Clock::now();
    ask_cache(*trainer_, neural::QueryPrecision::fp32, records_->units(setup_), points, answers);
    answered += seconds_since(begin);
  };
  const Clock::time_point begin = Clock::now();
  records_->finish(answer_tail, group.records);
  const double seconds = seconds_since(begin);
  statistics_.train_query_seconds += answered;
  statistics_.train_trace_seconds += seconds - answered;
  if (!ranks_) return;
  group.work.seconds += seconds;
  Bytes packed = pack_records(group.records, *ranks_, group.work);
  record_bytes_ += packed.size();
  group.coming = ranks_->ranks.begin_gather(std::move(packed));
}

void CacheSession::learn_from(Group& group, const Watch& watch) {
  const Clock::time_point begin = Clock::now();
  RecordBatch& records = group.records;
  unlearned_rays_.subtract(group.rays);
  for (std::size_t b = 0; b < records.starts.blocks(); ++b) {
    if (records.mine(b)) paths_of_rank_ += records.starts.offsets[b + 1] - records.starts.offsets[b];
  }
  if (group.coming) {
    const std::vector<RankWork> work = unpack_records(group.coming->wait(), *ranks_, records);
    work_.resize(work.size());
    for (std::size_t r = 0; r < work.size(); ++r) {
      work_[r].seconds += work[r].seconds;
      work_[r].rays += work[r].rays;
    }
  }
  records_->split(group.request, records);
  statistics_.training_paths += records.paths_traced;
  samples_ += group.samples();
  if (watch.samples && group.samples() > 0) watch.samples(records);
  statistics_.train_trace_seconds += seconds_since(begin);
  if (watch.before_learning) watch.before_learning(records);
  for (std::uint64_t batch = 0; batch < group.steps(); ++batch) {
    counts_.add(records, batch, steps_);
    learn(records, batch);
  }
  if (!trainer_->backend().runs_alongside()) look_at_answers(records);
  const auto longer = [](const RankWork& a, const RankWork& b) { return a.seconds < b.seconds; };
  const auto longest = std::max_element(work_.begin(), work_.end(), longer);
  if (!watch.rebalance || longest == work_.end() || longest->seconds < kRebalanceSeconds) return;
  watch.rebalance(work_);
  work_.clear();
}

void CacheSession::train(std::uint64_t steps, const Watch& watch) {
  const schedule::Section section("train");
  const Clock::time_point start = Clock::now();
  const double before = statistics_.train_seconds;
  const auto wanted = static_cast<int>(steps);
  // With ranks a group is traced while the records of the one before are exchanged. This is not possible
  // with candidates, which depend on the counts of the group before.
  const bool ahead = ranks_ && options_.cache.candidates == 1;
  const auto give_up = [&] {
    const double limit = options_.cache.train_seconds;
    if (watch.stop && watch.stop()) return true;
    if (limit <= 0.0) return false;
    const bool over = seconds_since(start) >= limit;
    return ranks_ ? agreed(ranks_->ranks, over) : over;
  };
  Group groups[2];
  Group *next = &groups[0], *last = ahead ? &groups[1] : next;
  Group* learning = nullptr;  // traced and finished, but not learned
  const auto learn_now = [&] {
    learn_from(*learning, watch);
    learning = nullptr;
    statistics_.train_seconds = before + seconds_since(start);
    if (watch.progress) watch.progress(static_cast<int>(steps_), wanted, statistics_.loss);
    if (watch.after_group) watch.after_group();
    return !give_up();
  };
  bool goes_on = true;
  while (goes_on) {
    const std::uint64_t under_way = learning ? learning->steps() : 0, step = steps_ + under_way;
    if (step >= steps && !learning) break;
    Group* group = nullptr;
    if (step < steps) {
      group = next;
      const std::uint64_t count = std::min(group_end(step), steps) - step;
      trace(step, count, samples_ + (learning ? learning->samples() : 0), *group);
    }
    if (learning) goes_on = learn_now();
    if (!group) continue;
    if (!goes_on) {
      // The group that was traced ahead will be traced again.
      unlearned_rays_.subtract(group->rays);
      abandoned_rays_.add(group->rays);
      break;
    }
    synchronize();  // the steps of the group before, which a device computed meanwhile
    look_at_answers(last->records);
    finish(*group);
    learning = group;
    std::swap(next, last);
    if (!ahead) goes_on = learn_now();
  }
  synchronize();
  look_at_answers(last->records);
  statistics_.train_seconds = before + seconds_since(start);
}

}  // namespace gatelight::renderer
