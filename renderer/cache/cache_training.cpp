// The training of a CacheSession.

#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <numeric>
#include <utility>

#include "base/clock.h"
#include "base/parallel/schedule.h"
#include "base/parallel/team.h"
#include "renderer/cache/cache_session.h"

namespace gatelight::renderer {
namespace {

/// The reported loss is the mean over this many last steps.
constexpr std::size_t kLossWindow = 64;

/// Records whose paths are traced together. Paths of several batches are more coherent, and threads wait less
/// often (5 to 10 % faster than single batches of 16384).
constexpr std::uint64_t kTracedRecords = 1 << 16;

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
  RecordRequest request = records_->request(setup_, step, records, !fits_);
  request.most_records = records;
  request.batches = count;
  request.first_sample = first_sample;
  request.counts_choice = exchange_.counts_common_rays();
  if (options_.cache.candidates > 1) request.counts = counts_.values();
  return request;
}

void CacheSession::learn(const RecordBatch& group, Team& team) {
  const bool alongside = trainer_->backend().runs_alongside();
  const std::uint64_t steps = group.batch_split.batches(), together = alongside ? steps : 1;
  std::vector<neural::TrainingBatch> batches(together);
  for (std::uint64_t first = 0; first < steps; first += together) {
    const schedule::Section section("step");
    for (std::uint64_t i = 0; i < together; ++i) {
      counts_.add(group, first + i, steps_ + i);
      batches[i] = group.batch(first + i);
    }
    trainer_->start(batches, &team);
    steps_ += together;
    steps_under_way_ += together;
    statistics_.steps += static_cast<int>(together);
    if (!alongside) synchronize();
  }
}

void CacheSession::synchronize() {
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
}

void CacheSession::look_at_answers(const RecordBatch& group) {
  if (!fits_) {  // answers for another light say nothing about the training
    guard_ = {};
    return;
  }
  const std::size_t some = std::min(TrainingGuard::kLookedAt, group.records.size());
  guard_.look_at_answers(group.targets, group.records.batch(0, some), *trainer_, steps_);
}

void CacheSession::begin(std::uint64_t step, std::uint64_t count, std::uint64_t first_sample, Group& group) {
  const Clock::time_point start = Clock::now();
  group.request = request(step, count, first_sample);
  group.rays = records_->rays();  // before it
  records_->begin(group.request, group.records);
  exchange_.choose_blocks(group.records);
  statistics_.train_trace_seconds += seconds_since(start);
}

void CacheSession::finish(Group& group) {
  const Clock::time_point begin = Clock::now();
  const bool threads = answers_threads();
  std::atomic<double> asked = 0.0;  // by all threads
  const auto ask = [&](const SurfacePoints& points, std::span<float> answers) {
    const Clock::time_point start = Clock::now();
    this->ask(neural::QueryPrecision::fp32, points, answers);
    asked += seconds_since(start);
  };
  records_->finish({ask, threads}, group.records);
  const double answered = asked / (threads ? tbb::this_task_arena::max_concurrency() : 1);
  const double seconds = seconds_since(begin);
  statistics_.train_query_seconds += answered;
  statistics_.train_trace_seconds += seconds - answered;
  group.work.seconds += seconds;
  group.coming = exchange_.send(group.records, group.work);
}

void CacheSession::receive(Group& group, const Watch& watch) {
  const Clock::time_point begin = Clock::now();
  RecordBatch& records = group.records;
  unlearned_rays_.subtract(group.rays);
  exchange_.receive(std::move(group.coming), records);
  records_->split(group.request, records);
  statistics_.training_paths += records.paths_traced;
  samples_ += group.samples();
  if (!fits_) look_at_light(records);
  if (!fits_) records.radiance.swap(records.traced);
  if (watch.samples && group.samples() > 0) watch.samples(records);
  statistics_.train_trace_seconds += seconds_since(begin);
}

void CacheSession::trace_and_learn(Group* next, Group* learning, const Watch& watch, Team& team) {
  std::atomic<double> traced = 0.0;  // by all threads
  // Records that come from elsewhere are received while the next ones are traced.
  const bool alone = exchange_.is_alone();
  if (learning && alone) receive(*learning, watch);
  const std::size_t blocks = next ? next->records.starts.blocks() : 0;
  team.beside(
      static_cast<std::uint32_t>(blocks),
      [&](std::size_t block) {
        const Clock::time_point start = Clock::now();
        records_->trace(next->records, block);
        traced += seconds_since(start);
      },
      [&] {
        if (!learning) return;
        if (!alone) receive(*learning, watch);
        learn(learning->records, team);
      });
  if (!next) return;
  RayCounts rays = records_->rays();
  rays.subtract(next->rays);
  next->rays = rays;
  unlearned_rays_.add(rays);
  next->work = {traced / tbb::this_task_arena::max_concurrency(), rays.camera + rays.bounce + rays.shadow};
  statistics_.train_trace_seconds += next->work.seconds;
}

void CacheSession::train(std::uint64_t steps, const Watch& watch) {
  const schedule::Section section("train");
  Team::run([&](Team& team) { train(steps, watch, team); });
}

void CacheSession::train(std::uint64_t steps, const Watch& watch, Team& team) {
  const Clock::time_point start = Clock::now();
  const double before = statistics_.train_seconds;
  const auto wanted = static_cast<int>(steps);
  // A group is traced while the one before is learned. This is not possible with candidates, which depend on
  // the counts of the group before.
  const bool ahead = options_.cache.candidates == 1;
  const auto give_up = [&] {
    const double limit = options_.cache.train_seconds;
    if (watch.stop && watch.stop()) return true;
    if (limit <= 0.0) return false;
    return exchange_.agreed(seconds_since(start) >= limit);
  };
  const auto note_seconds = [&] {
    CacheStatistics& s = statistics_;
    s.train_seconds = before + seconds_since(start);
    s.train_step_seconds = std::max(s.train_seconds - s.train_trace_seconds - s.train_query_seconds, 0.0);
  };
  Group groups[2];
  Group* learning = nullptr;  // traced and finished, but not learned
  for (bool goes_on = true; goes_on;) {
    const std::uint64_t step = steps_ + (learning ? learning->steps() : 0);
    Group* next = nullptr;
    if (step < steps && (ahead || !learning)) {
      next = learning == &groups[0] ? &groups[1] : &groups[0];
      const std::uint64_t count = std::min(group_end(step), steps) - step;
      begin(step, count, samples_ + (learning ? learning->samples() : 0), *next);
    }
    if (!next && !learning) break;
    trace_and_learn(next, learning, watch, team);
    if (learning) {
      synchronize();  // the steps of a device
      look_at_answers(learning->records);
      exchange_.rebalance(watch.rebalance);
      note_seconds();
      if (watch.progress) watch.progress(static_cast<int>(steps_), wanted, statistics_.loss);
      if (watch.after_group) watch.after_group();
      goes_on = !give_up();
    }
    if (next && goes_on) finish(*next);
    if (next && !goes_on) {
      // The group that was traced ahead will be traced again.
      unlearned_rays_.subtract(next->rays);
      abandoned_rays_.add(next->rays);
    }
    learning = next;
  }
  note_seconds();
}

}  // namespace gatelight::renderer
