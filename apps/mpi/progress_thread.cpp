#include "apps/mpi/progress_thread.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

#include "apps/mpi/failures.h"
#include "apps/terminal/signals.h"

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

ProgressThread::ProgressThread(const MpiWorld& world, Exchanges& exchanges, double silence_seconds)
    : world_(world),
      exchanges_{&exchanges},
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

void ProgressThread::fail(const Failure& fault) {
  {
    const std::lock_guard lock(mpi_mutex());
    if (world_.rank == 0) {
      errors_.add(0, fault);
    } else {
      mailbox_.send(0, kFaultTag, bytes_of(json_of(fault)));
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

/// The rank that has it is named.
void ProgressThread::abort(Failure fault, int rank) {
  fault.message.insert(0, world_.name_of(rank) + ": ");
  end_all(fault);
}

void ProgressThread::end_all(const Failure& failure) {
  while (aborting_.test_and_set()) std::this_thread::sleep_for(std::chrono::seconds(1));
  try {
    print_for_all(failure);
  } catch (...) {
    // The ranks are to end, with or without a line.
  }
  abort_all(failure.code);
}

void ProgressThread::run() {
  try {
    while (step()) {
      const bool busy = any_waiting() || [&] {
        const std::lock_guard lock(mpi_mutex());
        const bool exchanging = std::any_of(exchanges_.begin(), exchanges_.end(),
                                            [](const Exchanges* one) { return !one->idle(); });
        return exchanging || mailbox_.sending_any();
      }();
      std::this_thread::sleep_for(busy ? kBusyPause : kIdlePause);
    }
  } catch (const std::exception& error) {
    abort({kLost, error.what(), ""});
  }
}

/// Returns false after the end.
bool ProgressThread::step() {
  std::optional<Heartbeats::Lost> lost;
  std::optional<ErrorConsensus::Verdict> verdict;
  {
    const std::lock_guard lock(mpi_mutex());
    for (Exchanges* const one : exchanges_) one->advance();
    while (const std::optional<Mailbox::Message> message = mailbox_.receive()) receive(*message);
    lost = heartbeats_.step();
    verdict = errors_.take_verdict();
    if (stopping_ && heartbeats_.all_said_goodbye() && !mailbox_.sending_any()) return false;
  }
  if (verdict) reach_consensus(*verdict);
  if (lost) {
    end_all({kLost,
             fmt::format("rank {} ({}) has not answered for {:.0f} s; all ranks end", lost->rank,
                         world_.hosts[static_cast<std::size_t>(lost->rank)], lost->seconds),
             "--resume continues from the last --checkpoint"});
  }
  return true;
}

void ProgressThread::receive(const Mailbox::Message& message) {
  switch (message.tag) {
    case Heartbeats::kTag:
      heartbeats_.receive(message);
      break;
    case kFaultTag:
      errors_.add(message.rank, failure_of(object_of(message.bytes)));
      break;
    case kLeaveTag:
      may_leave_ = true;
      break;
    case kStopTag:
      request_stop(renderer::Unpacker(message.bytes).read<int>());
      break;
    default:
      break;
  }
}

void ProgressThread::reach_consensus(const ErrorConsensus::Verdict& verdict) {
  if (!verdict.shared) abort(verdict.fault, verdict.rank);
  print_for_all(verdict.fault);
  const std::lock_guard lock(mpi_mutex());
  for (int rank = 1; rank < world_.count; ++rank) mailbox_.send(rank, kLeaveTag, {});
  may_leave_ = true;
}

}  // namespace gatelight::apps
