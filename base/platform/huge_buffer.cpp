#include "base/platform/huge_buffer.h"

#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>

namespace gatelight::detail {

namespace {
#if defined(MADV_HUGEPAGE)
constexpr std::size_t kHugePage = std::size_t{2} << 20;
#else
constexpr std::size_t kHugePage = std::numeric_limits<std::size_t>::max();  // huge pages cannot be requested
#endif
constexpr std::size_t kPage = 4096;
}  // namespace

void Unmap::operator()(void* p) const {
  munmap(p, bytes);
}

void* map_huge(std::size_t bytes) {
  const int protection = PROT_READ | PROT_WRITE, flags = MAP_PRIVATE | MAP_ANONYMOUS;
  if (bytes < kHugePage) {
    void* p = mmap(nullptr, bytes, protection, flags, -1, 0);
    if (p == MAP_FAILED) throw std::bad_alloc();
    return p;
  }
  // Map too much, then trim to an aligned start.
  void* p = mmap(nullptr, bytes + kHugePage, protection, flags, -1, 0);
  if (p == MAP_FAILED) throw std::bad_alloc();
  const std::size_t beyond = reinterpret_cast<std::uintptr_t>(p) % kHugePage;
  const std::size_t before = beyond == 0 ? 0 : kHugePage - beyond;
  const std::size_t used = (bytes + kPage - 1) / kPage * kPage;
  const std::size_t after = bytes + kHugePage - before;
  std::byte* const aligned = static_cast<std::byte*>(p) + before;
  if (before > 0) munmap(p, before);
  if (after > used) munmap(aligned + used, after - used);
#if defined(MADV_HUGEPAGE)
  madvise(aligned, bytes, MADV_HUGEPAGE);  // only advice: ignoring errors costs time, not results
#endif
  return aligned;
}

}  // namespace gatelight::detail
