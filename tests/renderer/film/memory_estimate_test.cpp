#include "renderer/film/memory_estimate.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "tests/support/messages.h"

namespace gatelight::renderer {
namespace {

constexpr std::size_t kMebibyte = std::size_t{1} << 20;

TEST(RequireMemory, NamesTheNeededAndTheAvailableMemory) {
  const auto refusal = [](std::size_t limit, std::size_t all, std::size_t more) {
    RenderOptions options;
    options.memory_limit_bytes = limit;
    return tests::refusal<OutOfMemory>([&] { require_memory("it", options, all, more); });
  };
  EXPECT_EQ(refusal(0, 8 * kMebibyte, 4 * kMebibyte), "");
  EXPECT_EQ(refusal(8 * kMebibyte, 8 * kMebibyte, 0), "");
  tests::expect_message(refusal(7 * kMebibyte, 8 * kMebibyte, 0), {"it", "8 MiB", "`memory-limit` 7"});
  tests::expect_message(refusal(0, 0, std::size_t{1} << 60), {"it", "1099511627776 MiB"});
}

}  // namespace
}  // namespace gatelight::renderer
