#pragma once
// Ranks that are threads of one process, for tests.

#include <condition_variable>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "renderer/distributed/ranks.h"

namespace gatelight::tests {

using renderer::Bytes;

/// The sent messages: message number n of each rank to each.
class Mailboxes {
 public:
  explicit Mailboxes(int count) : count_(static_cast<std::size_t>(count)) {}

  void send(std::size_t rank, std::uint64_t number, std::vector<Bytes> outgoing) {
    const std::lock_guard lock(mutex_);
    Round& round = rounds_[number];
    round.outgoing.resize(count_);
    round.outgoing[rank] = std::move(outgoing);
    ++round.sent;
    changed_.notify_all();
  }
  std::vector<Bytes> receive(std::size_t rank, std::uint64_t number) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return rounds_[number].sent == count_; });
    Round& round = rounds_[number];
    std::vector<Bytes> incoming;
    for (std::vector<Bytes>& from : round.outgoing) incoming.push_back(std::move(from[rank]));
    if (++round.received == count_) rounds_.erase(number);
    return incoming;
  }
  std::size_t count() const { return count_; }

 private:
  struct Round {
    std::vector<std::vector<Bytes>> outgoing;
    std::size_t sent = 0, received = 0;
  };
  std::size_t count_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::uint64_t, Round> rounds_;
};

class ThreadRank final : public renderer::Ranks {
 public:
  ThreadRank(int rank, Mailboxes& boxes) : rank_(static_cast<std::size_t>(rank)), boxes_(boxes) {}

  int rank() const override { return static_cast<int>(rank_); }
  int count() const override { return static_cast<int>(boxes_.count()); }
  std::unique_ptr<Exchange> begin_exchange(std::vector<Bytes> outgoing) override {
    struct Coming : Exchange {
      ThreadRank* rank;
      std::uint64_t number;
      std::vector<Bytes> wait() override { return rank->boxes_.receive(rank->rank_, number); }
    };
    auto coming = std::make_unique<Coming>();
    coming->rank = this;
    coming->number = next_++;
    if (outgoing.size() == 1) outgoing.resize(boxes_.count(), Bytes(outgoing[0]));
    for (std::size_t r = 0; r < outgoing.size(); ++r) sent_ += r == rank_ ? 0 : outgoing[r].size();
    boxes_.send(rank_, coming->number, std::move(outgoing));
    return coming;
  }
  renderer::Traffic traffic() const override { return {sent_, 0.0}; }

 private:
  std::size_t rank_;
  Mailboxes& boxes_;
  std::uint64_t next_ = 0;
  std::uint64_t sent_ = 0;
};

/// Runs the function at `count` ranks, each a thread. It must end at all ranks or at none. Throws what the
/// first rank of them throws.
inline void run_ranks(int count, const std::function<void(renderer::Ranks&)>& function) {
  Mailboxes boxes(count);
  std::vector<std::thread> threads;
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count));
  for (int rank = 0; rank < count; ++rank) {
    threads.emplace_back([&, rank] {
      ThreadRank self(rank, boxes);
      try {
        function(self);
      } catch (...) {
        failures[static_cast<std::size_t>(rank)] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace gatelight::tests
