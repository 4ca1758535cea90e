#include "base/parallel/team.h"

#include <thread>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace gatelight {
namespace {

/// Waits a little for another thread; longer waits leave the core to others.
class Pause {
 public:
  void operator()() {
    constexpr int kShort = 1000;
    if (++count_ > kShort) return std::this_thread::yield();
#if defined(__x86_64__)
    _mm_pause();
#endif
  }

 private:
  int count_ = 0;
};

constexpr std::uint64_t kIndex = 0xffffffffu;

}  // namespace

bool Team::take_part() {
  std::uint64_t next = next_.load(std::memory_order_acquire);
  for (;;) {
    const std::uint32_t count = count_.load(std::memory_order_acquire);
    const Call call = call_.load(std::memory_order_acquire);
    const void* const body = body_.load(std::memory_order_acquire);
    const auto begin = static_cast<std::uint32_t>(next & kIndex);
    if (begin >= count) return false;
    const std::uint32_t size = std::max((count - begin) / (2 * threads_), 1u);
    if (!next_.compare_exchange_weak(next, next + size, std::memory_order_acq_rel, std::memory_order_acquire))
      continue;
    try {
      call(body, begin, begin + size);
    } catch (...) {
      if (!failed_.exchange(true)) failure_ = std::current_exception();
    }
    done_.fetch_add(size, std::memory_order_release);
    return true;
  }
}

void Team::help() {
  Pause pause;
  while (!ended_.load(std::memory_order_acquire)) {
    if (take_part())
      pause = {};
    else
      pause();
  }
}

void Team::begin_loop(std::uint32_t count, Call call, const void* body) {
  // No index can be taken while the parts of two loops are mixed: who reads a new part finds `next_` changed.
  const std::uint64_t loop = (next_.load(std::memory_order_relaxed) >> 32) + 1;
  next_.store(loop << 32 | kIndex, std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  count_.store(count, std::memory_order_release);
  call_.store(call, std::memory_order_release);
  body_.store(body, std::memory_order_release);
  next_.store((loop + 1) << 32, std::memory_order_release);
}

void Team::end_loop() {
  Pause pause;
  const std::uint32_t count = count_.load(std::memory_order_relaxed);
  while (done_.load(std::memory_order_acquire) < count) pause();
  if (failed_.load(std::memory_order_acquire)) {
    const std::exception_ptr failure = failure_;
    failed_ = false;
    std::rethrow_exception(failure);
  }
}

}  // namespace gatelight
