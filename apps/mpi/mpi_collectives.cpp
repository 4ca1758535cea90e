#include "apps/mpi/mpi_collectives.h"

#include <cstdint>
#include <mutex>
#include <span>
#include <utility>

#include "apps/mpi/mpi_calls.h"
#include "base/clock.h"

namespace gatelight::apps {
namespace {

using renderer::Bytes;

/// Adds its lifetime to a sum.
class WaitingTime {
 public:
  explicit WaitingTime(double& seconds) : seconds_(seconds) {}
  ~WaitingTime() { seconds_ += seconds_since(begin_); }
  WaitingTime(const WaitingTime&) = delete;
  WaitingTime& operator=(const WaitingTime&) = delete;

 private:
  double& seconds_;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace

void MpiCollectives::broadcast(Bytes& bytes) {
  const WaitingTime time(traffic_.waiting_seconds);
  struct Broadcast {
    Bytes bytes;
    std::uint64_t size = 0;
    Requests requests;
  };
  const MpiMemory<Broadcast> all;
  all->bytes = std::move(bytes);
  all->size = all->bytes.size();
  const auto send = [&](std::span<std::byte> values) {
    all->requests.clear();
    {
      const std::lock_guard lock(mpi_mutex());
      begin_broadcast(group_.data, values, all->requests);
    }
    wait_for(all->requests);
  };
  send(std::as_writable_bytes(std::span(&all->size, 1)));
  all->bytes.resize(all->size);
  send(all->bytes);
  bytes = std::move(all->bytes);
  if (first()) traffic_.bytes_sent += all->size * static_cast<std::uint64_t>(count() - 1);
}

std::unique_ptr<renderer::Ranks::Exchange> MpiCollectives::begin_exchange(std::vector<Bytes> outgoing) {
  struct Running : renderer::Ranks::Exchange {
    explicit Running(MpiCollectives& collectives) : mpi(collectives) {}
    std::vector<Bytes> wait() override {
      const WaitingTime time(mpi.traffic_.waiting_seconds);
      for (Pauses pauses;; pauses.sleep()) {
        const std::lock_guard lock(mpi_mutex());
        mpi.exchanges_.advance();
        if (exchange->over()) return exchange->take();
      }
    }
    MpiCollectives& mpi;
    std::shared_ptr<apps::Exchange> exchange;
  };
  auto running = std::make_unique<Running>(*this);
  const std::lock_guard lock(mpi_mutex());
  running->exchange = exchanges_.begin(std::move(outgoing));
  traffic_.bytes_sent += running->exchange->bytes_sent();
  return running;
}

}  // namespace gatelight::apps
