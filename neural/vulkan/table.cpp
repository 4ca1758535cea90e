#include "neural/vulkan/table.h"

#include <algorithm>
#include <bit>

namespace gatelight::neural::vulkan {

Table::Table(const Device& device, Transfer& transfer, std::uint64_t entries, std::uint32_t stride,
             std::uint64_t longest_part)
    : entries_(std::max<std::uint64_t>(entries, 1)), stride_(std::max(stride, 1u)) {
  const std::uint64_t fitting = std::bit_floor(std::max<std::uint64_t>(longest_part / (4 * stride_), 1));
  const std::uint64_t part_entries = std::min(fitting, std::bit_ceil(entries_));
  shift_ = static_cast<std::uint32_t>(std::bit_width(part_entries)) - 1;
  std::vector<Address> addresses;
  for (std::uint64_t first = 0; first < entries_; first += part_entries) {
    parts_.emplace_back(device, 4 * stride_ * std::min(part_entries, entries_ - first), BufferUse::device);
    addresses.push_back(parts_.back().address());
  }
  addresses_ = Buffer(device, addresses.size() * sizeof(Address), BufferUse::device);
  transfer.write(addresses_, std::as_bytes(std::span(addresses)));
}

template <class Body>
void Table::for_parts(std::uint64_t words, Body&& body) const {
  std::uint64_t first = 0;
  for (const Buffer& part : parts_) {
    const std::uint64_t count = std::min(part.bytes() / 4, words - first);
    if (count > 0) body(part, first, count);
    first += count;
  }
}

void Table::write(Transfer& transfer, std::span<const std::uint32_t> words) {
  for_parts(words.size(), [&](const Buffer& part, std::uint64_t first, std::uint64_t count) {
    transfer.write(part, std::as_bytes(words.subspan(first, count)));
  });
}

void Table::read(Transfer& transfer, std::span<std::uint32_t> words) const {
  for_parts(words.size(), [&](const Buffer& part, std::uint64_t first, std::uint64_t count) {
    transfer.read(part, std::as_writable_bytes(words.subspan(first, count)));
  });
}

void Table::fill(Transfer& transfer, std::uint32_t word) {
  for (const Buffer& part : parts_) transfer.fill(part, word);
}

}  // namespace gatelight::neural::vulkan
