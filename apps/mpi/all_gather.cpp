#include "apps/mpi/all_gather.h"

#include <cstdint>
#include <exception>
#include <numeric>
#include <utility>

#include "apps/mpi/mpi_calls.h"

namespace gatelight::apps {
namespace {

using renderer::Bytes;

/// Limit for MPI_Iallgatherv, which needs one contiguous buffer and int offsets, and costs a copy. More bytes
/// are received by point-to-point messages, directly in their final buffers.
constexpr std::uint64_t kMaxAtOnce = std::uint64_t{1} << 20;

}  // namespace

class AllGathers::Gather {
 public:
  Gather(const MpiGroup& group, Bytes mine)
      : group_(group), mine_(std::move(mine)), size_(mine_.size()), sizes_(ranks()) {}

  bool over() const { return step_ == Step::over; }

  /// Takes at most one step, because the next one may take long: it allocates the buffers.
  void advance() {
    try {
      if (!over() && all_done(requests_)) next_step();
    } catch (...) {
      error_ = std::current_exception();
      step_ = Step::over;
    }
  }

  bool failed() const { return error_ != nullptr; }

  std::vector<Bytes> take() {
    if (error_) std::rethrow_exception(error_);
    return std::move(results_);
  }

 private:
  enum class Step { begin, sizes, bytes, over };

  std::size_t ranks() const { return static_cast<std::size_t>(group_.count); }

  void next_step() {
    requests_.clear();
    switch (step_) {
      case Step::begin:
        begin_sizes();
        step_ = Step::sizes;
        break;
      case Step::sizes:
        if (std::accumulate(sizes_.begin(), sizes_.end(), std::uint64_t{0}) <= kMaxAtOnce) {
          begin_bytes();
        } else {
          begin_many_bytes();
        }
        step_ = Step::bytes;
        break;
      case Step::bytes:
        finish();
        step_ = Step::over;
        break;
      case Step::over:
        break;
    }
  }

  void begin_sizes() {
    requests_.push_back(kNoRequest);
    check(MPI_Iallgather(&size_, 1, kUint64, sizes_.data(), 1, kUint64, group_.all_gathers, requests_.data()),
          "MPI_Iallgather");
  }

  void begin_bytes() {
    int offset = 0;
    for (const std::uint64_t size : sizes_) {
      counts_.push_back(static_cast<int>(size));
      offsets_.push_back(offset);
      offset += counts_.back();
    }
    all_.resize(static_cast<std::size_t>(offset));
    requests_.push_back(kNoRequest);
    check(MPI_Iallgatherv(mine_.data(), static_cast<int>(size_), kByte, all_.data(), counts_.data(),
                          offsets_.data(), kByte, group_.all_gathers, requests_.data()),
          "MPI_Iallgatherv");
  }

  void begin_many_bytes() {
    results_.resize(ranks());
    for (int i = 1; i < group_.count; ++i) {
      const int from = (group_.rank + group_.count - i) % group_.count;
      Bytes& theirs = results_[static_cast<std::size_t>(from)];
      theirs.resize(sizes_[static_cast<std::size_t>(from)]);
      begin_receive(group_.all_gathers, from, theirs, requests_);
    }
    for (int i = 1; i < group_.count; ++i)
      begin_send(group_.all_gathers, (group_.rank + i) % group_.count, mine_, requests_);
  }

  void finish() {
    if (results_.empty()) {
      const std::byte* at = all_.data();
      for (const std::uint64_t size : sizes_) {
        results_.emplace_back(at, at + size);
        at += size;
      }
    } else {
      results_[static_cast<std::size_t>(group_.rank)] = std::move(mine_);
    }
  }

  const MpiGroup& group_;
  Bytes mine_;
  std::uint64_t size_ = 0;
  std::vector<std::uint64_t> sizes_;
  std::vector<int> counts_, offsets_;
  Bytes all_;                   // of all ranks, for MPI_Iallgatherv: one after the other
  std::vector<Bytes> results_;  // one entry per rank
  Requests requests_;
  Step step_ = Step::begin;
  std::exception_ptr error_;
};

std::shared_ptr<AllGathers::Gather> AllGathers::begin(Bytes mine) {
  auto gather = std::make_shared<Gather>(group_, std::move(mine));
  waiting_.push_back(gather);
  if (waiting_.size() == 1) advance();
  return gather;
}

void AllGathers::advance() {
  if (waiting_.empty()) return;
  Gather& first = *waiting_.front();
  first.advance();
  if (!first.over()) return;
  if (first.failed()) failed_.push_back(waiting_.front());
  waiting_.pop_front();
}

bool AllGathers::over(const Gather& gather) {
  return gather.over();
}

std::vector<Bytes> AllGathers::take(Gather& gather) {
  return gather.take();
}

}  // namespace gatelight::apps
