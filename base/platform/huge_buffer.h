#pragma once
// Large arrays on huge pages, if the system grants them. Random reads then have fewer TLB misses (measured in
// neural/cpu/README.md). A page is cleared when it is first touched, by the thread that does so.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>
#include <utility>

namespace gatelight {

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
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  HugeBuffer() = default;
  explicit HugeBuffer(std::size_t size) : size_(size) {
    const std::size_t bytes = size * sizeof(T) + 64;
    data_ = {static_cast<T*>(detail::map_huge(bytes)), detail::Unmap{bytes}};
  }
  HugeBuffer(const HugeBuffer& other) {
    if (other.empty()) return;
    *this = HugeBuffer(other.size_);
    std::copy_n(other.data(), size_, data());
  }
  HugeBuffer(HugeBuffer&& other) noexcept
      : data_(std::move(other.data_)), size_(std::exchange(other.size_, 0)) {}
  HugeBuffer& operator=(HugeBuffer other) noexcept {
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
    return *this;
  }
  friend bool operator==(const HugeBuffer& a, const HugeBuffer& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }
  T* data() const { return data_.get(); }
  T* begin() const { return data(); }
  T* end() const { return data() + size_; }
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

}  // namespace gatelight
