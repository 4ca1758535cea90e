#include "apps/mpi/progress_thread.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

namespace gatelight::apps {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::microseconds kBusyPause(200);
constexpr std::chrono::microseconds kIdlePause(2000);
constexpr std::chrono::seconds kFirstAnswersWithin(10);

constexpr int kFaultTag = 2;
constexpr int kLeaveTag = 3;
constexpr int kStopTag = 4;

}  // namespace

ProgressThread::ProgressThread(const MpiWorld& world, AllGathers& all_gathers, RankCallbacks callbacks,
                               double silence_seconds)
    : world_(world),
      gatherings_{&all_gathers},
      callbacks_(std::move(callbacks)),
      mailbox_(world.messages),
      heartbeats_(world, mailbox_, silence_seconds),
      errors_(world.count),
      thread_([this] { run(); }) {}

void ProgressThread::stop_others(int signal) {
  const std::lock_guard lock(mpi_mutex());
  for (int rank = 0; rank < world_.count; ++rank) {
    if (rank == world_.rank) continue;
    renderer::Packer packer;
    packer.add(signal);
    mailbox_.send(rank, kStopTag, packer.take());
  }
}

void ProgressThread::fail(const RankError& fault) {
  {
    const std::lock_guard lock(mpi_mutex());
    if (world_.rank == 0) {
      errors_.add(0, fault);
    } else {
      mailbox_.send(0, kFaultTag, packed(fault));
    }
  }
  const auto end = steady_clock::now() + kFirstAnswersWithin;
  for (Pauses pauses; !may_leave_; pauses.sleep()) {
    if (steady_clock::now() > end) abort(fault);
  }
}

void ProgressThread::stop() {
  {
    const std::lock_guard lock(mpi_mutex());
    stopping_ = true;
    heartbeats_.announce_exit();
  }
  thread_.join();
}

void ProgressThread::abort(const RankError& fault) {
  abort(fault.code,
        [&] { callbacks_.on_fault(fault.code, name_of(world_, world_.rank) + ": " + fault.line); });
}

void ProgressThread::abort(int code, const std::function<void()>& print) {
  while (aborting_.test_and_set()) std::this_thread::sleep_for(std::chrono::seconds(1));
  try {
    print();
  } catch (...) {
    // The ranks are to end, with or without a line.
  }
  abort_all(code);
}

void ProgressThread::run() {
  try {
    while (step()) {
      const bool busy = any_waiting() || [&] {
        const std::lock_guard lock(mpi_mutex());
        const bool gathers = std::any_of(gatherings_.begin(), gatherings_.end(),
                                         [](const AllGathers* one) { return !one->idle(); });
        return gathers || mailbox_.sending_any();
      }();
      std::this_thread::sleep_for(busy ? kBusyPause : kIdlePause);
    }
  } catch (const std::exception& error) {
    abort({.code = callbacks_.lost_code, .line = error.what()});
  }
}

/// Returns false after the end.
bool ProgressThread::step() {
  std::optional<Heartbeats::Lost> lost;
  std::optional<ErrorConsensus::Verdict> verdict;
  {
    const std::lock_guard lock(mpi_mutex());
    for (AllGathers* const one : gatherings_) one->advance();
    while (const std::optional<Mailbox::Message> message = mailbox_.receive()) receive(*message);
    lost = heartbeats_.step();
    verdict = errors_.take_verdict();
    if (stopping_ && heartbeats_.all_said_goodbye() && !mailbox_.sending_any()) return false;
  }
  if (verdict) reach_consensus(*verdict);
  if (lost) {
    abort(callbacks_.lost_code, [&] {
      callbacks_.on_lost(lost->rank, world_.hosts[static_cast<std::size_t>(lost->rank)], lost->seconds);
    });
  }
  return true;
}

void ProgressThread::receive(const Mailbox::Message& message) {
  switch (message.tag) {
    case Heartbeats::kTag:
      heartbeats_.receive(message);
      break;
    case kFaultTag:
      errors_.add(message.rank, unpacked(message.bytes));
      break;
    case kLeaveTag:
      may_leave_ = true;
      break;
    case kStopTag:
      callbacks_.on_stop(renderer::Unpacker(message.bytes).read<int>());
      break;
    default:
      break;
  }
}

void ProgressThread::reach_consensus(const ErrorConsensus::Verdict& verdict) {
  const RankError& fault = verdict.fault;
  if (!verdict.shared) {
    abort(fault.code,
          [&] { callbacks_.on_fault(fault.code, name_of(world_, verdict.rank) + ": " + fault.line); });
  }
  callbacks_.on_fault(fault.code, fault.line);
  const std::lock_guard lock(mpi_mutex());
  for (int rank = 1; rank < world_.count; ++rank) mailbox_.send(rank, kLeaveTag, {});
  may_leave_ = true;
}

}  // namespace gatelight::apps
