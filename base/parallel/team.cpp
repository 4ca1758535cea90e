#include "base/parallel/team.h"

#include <thread>
#include <utility>

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

thread_local Team* Team::led_ = nullptr;

void Team::Work::begin(std::uint32_t count, Call call, const void* body) {
  // No index can be taken while the parts of two works are mixed: who reads a new part finds `next_` changed.
  const std::uint64_t number = (next_.load(std::memory_order_relaxed) >> 32) + 1;
  next_.store(number << 32 | kIndex, std::memory_order_relaxed);
  done_.store(0, std::memory_order_relaxed);
  count_.store(count, std::memory_order_release);
  call_.store(call, std::memory_order_release);
  body_.store(body, std::memory_order_release);
  next_.store((number + 1) << 32, std::memory_order_release);
}

bool Team::Work::take_part(std::uint32_t share) {
  std::uint64_t next = next_.load(std::memory_order_acquire);
  for (;;) {
    const std::uint32_t count = count_.load(std::memory_order_acquire);
    const Call call = call_.load(std::memory_order_acquire);
    const void* const body = body_.load(std::memory_order_acquire);
    const auto begin = static_cast<std::uint32_t>(next & kIndex);
    if (begin >= count) return false;
    const std::uint32_t size = std::max((count - begin) / share, 1u);
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

void Team::Work::cancel() {
  const std::uint32_t count = count_.load(std::memory_order_relaxed);
  std::uint64_t next = next_.load(std::memory_order_relaxed);
  while (!next_.compare_exchange_weak(next, (next | kIndex) - kIndex + count, std::memory_order_acq_rel)) {
  }
  done_.fetch_add(count - static_cast<std::uint32_t>(next & kIndex), std::memory_order_relaxed);
  try {
    end();
  } catch (...) {  // of a task; the lead's own goes on
  }
}

void Team::Work::end() {
  Pause pause;
  const std::uint32_t count = count_.load(std::memory_order_relaxed);
  while (done_.load(std::memory_order_acquire) < count) pause();
  if (!failed_.load(std::memory_order_acquire)) return;
  const std::exception_ptr failure = std::exchange(failure_, nullptr);
  failed_ = false;
  std::rethrow_exception(failure);
}

void Team::help() {
  Pause pause;
  while (!ended_.load(std::memory_order_acquire)) {
    if (tasks_.take_part(~0u) || loop_.take_part(2 * threads_))
      pause = {};
    else
      pause();
  }
}

}  // namespace gatelight
