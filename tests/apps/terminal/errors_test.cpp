#include "apps/terminal/errors.h"

#include <gtest/gtest.h>

#include <new>

#include "neural/base/errors.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "renderer/render.h"
#include "scene/gltf.h"
#include "tests/support/messages.h"

namespace gatelight::apps {
namespace {

template <typename Exception>
Failure failure_of(const Exception& exception) {
  try {
    throw exception;
  } catch (...) {
    return describe_current_exception();
  }
}

TEST(ExitCodes, EachKindOfExceptionHasItsCode) {
  EXPECT_EQ(failure_of(UsageError("m")).code, 1);
  EXPECT_EQ(failure_of(renderer::BadOption("m")).code, 1);
  EXPECT_EQ(failure_of(renderer::UnknownFormat("m")).code, 1);
  EXPECT_EQ(failure_of(InputError("m")).code, 2);
  EXPECT_EQ(failure_of(scene::SceneError("m")).code, 2);
  EXPECT_EQ(failure_of(renderer::ImageError("m")).code, 2);
  EXPECT_EQ(failure_of(std::runtime_error("m")).code, 2);
  EXPECT_EQ(failure_of(renderer::OutputError("m")).code, 3);
  EXPECT_EQ(failure_of(renderer::OutOfMemory("m")).code, 4);
  EXPECT_EQ(failure_of(std::bad_alloc()).code, 4);
  EXPECT_EQ(failure_of(std::bad_array_new_length()).code, 4);
  EXPECT_EQ(failure_of(renderer::Unavailable("m")).code, 5);
  EXPECT_EQ(failure_of(neural::BadConfiguration("m")).code, 1);
  EXPECT_EQ(failure_of(neural::CacheFileError("m")).code, 2);
  EXPECT_EQ(failure_of(neural::Unavailable("m")).code, 5);
  EXPECT_EQ(failure_of(renderer::NumericalError("m")).code, 6);
  EXPECT_EQ(failure_of(renderer::TrainingDiverged("m")).code, 6);
}

TEST(ExitCodes, TheMessageIsKeptAndAdviceGiven) {
  const Failure failure = failure_of(renderer::OutOfMemory("needs 3 GiB"));
  EXPECT_EQ(failure.message, "needs 3 GiB");
  tests::expect_message(failure.advice, {"limit"});
}

TEST(ExitCodes, ADivergedTrainingHasAdviceOfItsOwn) {
  tests::expect_message(failure_of(renderer::TrainingDiverged("m")).advice, {"--learning-rate"});
  tests::expect_message(failure_of(renderer::NumericalError("m")).advice, {"--nan drop"});
}

TEST(ExitCodes, TheLastLineIsOneLine) {
  ::testing::internal::CaptureStderr();
  print_failure({kInput, "first\nsecond", "do this"});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "gatelight: error: first second; do this\n");
}

}  // namespace
}  // namespace gatelight::apps
