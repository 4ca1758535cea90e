#pragma once
// An array of entries of `stride` words, divided into parts that fit one buffer of the device.

#include <cstdint>
#include <span>
#include <vector>

#include "neural/vulkan/blocks.h"
#include "neural/vulkan/transfer.h"

namespace gatelight::neural::vulkan {

class Table {
 public:
  Table() = default;
  /// Allocates at least one entry, so that there is an address. Parts have 2^k entries and at most
  /// `longest_part` bytes.
  Table(const Device& device, Transfer& transfer, std::uint64_t entries, std::uint32_t stride,
        std::uint64_t longest_part);

  bool empty() const { return parts_.empty(); }
  std::uint64_t bytes() const { return 4 * entries_ * stride_; }
  TableBlock block() const { return {addresses_.address(), shift_, stride_}; }

  /// `words` are those of all entries.
  void write(Transfer& transfer, std::span<const std::uint32_t> words);
  void read(Transfer& transfer, std::span<std::uint32_t> words) const;
  void fill(Transfer& transfer, std::uint32_t word);

 private:
  /// Calls body(part, the part's range of words).
  template <class Body>
  void for_parts(std::uint64_t words, Body&& body) const;

  std::uint64_t entries_ = 0;
  std::uint32_t stride_ = 0, shift_ = 0;
  std::vector<Buffer> parts_;
  Buffer addresses_;
};

}  // namespace gatelight::neural::vulkan
