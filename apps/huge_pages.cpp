// Large arrays lie in huge pages, where the system has them (transparent huge pages, "madvise" or "always"),
// and memory that was freed is kept for the next array. First touches of small pages are slow on virtual
// machines: finishing a picture, which uses many arrays for a short time, took twice as long there. The
// arrays are vectors, so the program replaces the allocation functions of C++ instead of naming an allocator
// in each.

#include <malloc.h>
#include <sys/mman.h>

#include <climits>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>

// The address and thread sanitizers bring functions of their own.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace {

constexpr std::size_t kHugePage = std::size_t{2} << 20;

/// Arrays of less than glibc's largest limit come from the heap, and the heap does not shrink.
const bool kept = ::mallopt(M_MMAP_THRESHOLD, 32 << 20) + ::mallopt(M_TRIM_THRESHOLD, INT_MAX) == 2;

void* allocate(std::size_t bytes) {
  if (bytes < kHugePage / 2) return std::malloc(bytes > 0 ? bytes : 1);
  if (bytes > PTRDIFF_MAX) return nullptr;
  // The last page is a huge one too, if the array fills half of it.
  const std::size_t beyond = bytes % kHugePage;
  const std::size_t size = beyond > kHugePage / 2 ? bytes - beyond + kHugePage : bytes;
  void* memory = nullptr;
  if (::posix_memalign(&memory, kHugePage, size) != 0) return nullptr;
#if defined(MADV_HUGEPAGE)
  ::madvise(memory, size, MADV_HUGEPAGE);  // only advice: ignoring errors costs time, not results
#endif
  return memory;
}

}  // namespace

void* operator new(std::size_t bytes) {
  for (;;) {
    if (void* const memory = allocate(bytes)) return memory;
    const std::new_handler handler = std::get_new_handler();
    if (!handler) throw std::bad_alloc();
    handler();
  }
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

#endif
