// A trainer checks its parts.

#include <gtest/gtest.h>

#include <memory>

#include "tests/neural/model/cache_files.h"

namespace gatelight::neural::testing {
namespace {

TEST(Trainer, RefusesMissingPartsAndBadOptions) {
  const ModelCase c = tiny_case();
  const auto held = [&] { return std::make_unique<StoredState>(c.model, TrainingOptions{}, ModelState{}); };
  EXPECT_THROW(Trainer(nullptr, {}, held()), BadConfiguration);
  EXPECT_THROW(Trainer(c.model, {}, nullptr), BadConfiguration);
  TrainingOptions options;
  options.adam.beta1 = 1.0f;
  EXPECT_THROW(Trainer(c.model, options, held()), BadConfiguration);
}

}  // namespace
}  // namespace gatelight::neural::testing
