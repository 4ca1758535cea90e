#pragma once
// A vector with readable bytes behind its last element.

#include <cstddef>
#include <new>
#include <vector>

namespace gatelight {

/// Allocates 16 bytes more than requested: Embree loads vertices of 12 bytes with reads of 16.
template <typename T>
struct PaddedAllocator {
  using value_type = T;
  static constexpr std::size_t kPaddingBytes = 16;

  PaddedAllocator() = default;
  template <typename U>
  PaddedAllocator(const PaddedAllocator<U>&) {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T) + kPaddingBytes));
  }
  void deallocate(T* data, std::size_t) { ::operator delete(data); }

  friend bool operator==(PaddedAllocator, PaddedAllocator) { return true; }
};

template <typename T>
using PaddedVector = std::vector<T, PaddedAllocator<T>>;

}  // namespace gatelight
