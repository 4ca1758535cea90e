#include "neural/cpu/huge_buffer.h"

#include <sys/mman.h>

#include <new>

namespace gatelight::neural::cpu::detail {

namespace {
constexpr std::size_t kHugePage = std::size_t{2} << 20;
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
  // Mapped too large, then trimmed to an aligned start.
  void* p = mmap(nullptr, bytes + kHugePage, protection, flags, -1, 0);
  if (p == MAP_FAILED) throw std::bad_alloc();
  const auto begin = reinterpret_cast<std::uintptr_t>(p);
  const std::uintptr_t aligned = (begin + kHugePage - 1) / kHugePage * kHugePage;
  const std::uintptr_t end = begin + bytes + kHugePage;
  const std::uintptr_t used_end = (aligned + bytes + kPage - 1) / kPage * kPage;
  if (aligned > begin) munmap(p, aligned - begin);
  if (end > used_end) munmap(reinterpret_cast<void*>(used_end), end - used_end);
  madvise(reinterpret_cast<void*>(aligned), bytes,
          MADV_HUGEPAGE);  // advice: a refusal costs time, not results
  return reinterpret_cast<void*>(aligned);
}

}  // namespace gatelight::neural::cpu::detail
