#pragma once
// Blocking copies between host and device, for states but not for steps.

#include <cstddef>
#include <span>

#include "neural/vulkan/submission.h"

namespace gatelight::neural::vulkan {

class Transfer {
 public:
  explicit Transfer(const Device& device) : device_(device), work_(device) {}

  /// The copies run after everything submitted before.
  void write(const Buffer& to, std::span<const std::byte> bytes);
  void read(const Buffer& from, std::span<std::byte> bytes);
  void fill(const Buffer& to, std::uint32_t word);

 private:
  template <class Record>
  void submit(Record&& record);

  const Device& device_;
  Submission work_;
};

}  // namespace gatelight::neural::vulkan
