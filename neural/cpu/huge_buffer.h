#pragma once
// Large arrays on huge pages, if the system grants them. Random reads then have fewer TLB misses (measured in
// the README).

#include <cstddef>
#include <cstdint>
#include <memory>

namespace gatelight::neural::cpu {

namespace detail {
struct Unmap {
  std::size_t bytes = 0;
  void operator()(void* p) const;
};
/// Returns zeroed memory, aligned to 2 MiB if it is at least that large, else to 64 bytes. Throws
/// std::bad_alloc.
void* map_huge(std::size_t bytes);
}  // namespace detail

/// A fixed-size array of a trivial type, initially zero, with 64 bytes of padding behind its end.
template <class T>
class HugeBuffer {
 public:
  HugeBuffer() = default;
  explicit HugeBuffer(std::size_t size) : size_(size) {
    const std::size_t bytes = size * sizeof(T) + 64;
    data_ = {static_cast<T*>(detail::map_huge(bytes)), detail::Unmap{bytes}};
  }
  T* data() const { return data_.get(); }
  std::size_t size() const { return size_; }
  T& operator[](std::size_t i) const { return data_.get()[i]; }
  bool empty() const { return size_ == 0; }
  std::uint64_t bytes() const { return size_ * sizeof(T); }

 private:
  std::unique_ptr<T[], detail::Unmap> data_;
  std::size_t size_ = 0;
};

/// Makes the buffer at least `size` long; growing loses its contents.
template <class T>
void reserve(HugeBuffer<T>& buffer, std::size_t size) {
  if (buffer.size() < size) {
    buffer = HugeBuffer<T>();
    buffer = HugeBuffer<T>(size);
  }
}

}  // namespace gatelight::neural::cpu
