#include "apps/terminal/errors.h"

#include <gtest/gtest.h>

#include <new>

#include "base/errors.h"
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
  EXPECT_EQ(failure_of(BadOption("m")).code, 1);
  EXPECT_EQ(failure_of(UnknownFormat("m")).code, 1);
  EXPECT_EQ(failure_of(InputError("m")).code, 2);
  EXPECT_EQ(failure_of(OutputError("m")).code, 3);
  EXPECT_EQ(failure_of(OutOfMemory("m")).code, 4);
  EXPECT_EQ(failure_of(OutOfDeviceMemory("m")).code, 4);
  EXPECT_EQ(failure_of(std::bad_alloc()).code, 4);
  EXPECT_EQ(failure_of(std::bad_array_new_length()).code, 4);
  EXPECT_EQ(failure_of(Unavailable("m")).code, 5);
  EXPECT_EQ(failure_of(MissingDenoiser("m")).code, 5);
  EXPECT_EQ(failure_of(MissingLibrary("m")).code, 5);
  EXPECT_EQ(failure_of(DeviceLost("m")).code, 5);
  EXPECT_EQ(failure_of(BadConfiguration("m")).code, 1);
  EXPECT_EQ(failure_of(CacheFileError("m")).code, 2);
  EXPECT_EQ(failure_of(NumericalError("m")).code, 6);
  EXPECT_EQ(failure_of(TrainingDiverged("m")).code, 6);
  EXPECT_EQ(failure_of(MpiError("m")).code, 9);
}

TEST(ExitCodes, AnExceptionWithoutAKindIsAnErrorOfTheProgram) {
  const Failure failure = failure_of(std::logic_error("m"));
  EXPECT_EQ(failure.code, 1);
  tests::expect_message(failure.message, {"internal error"});
}

TEST(ExitCodes, TheMessageIsKeptAndAdviceGiven) {
  const Failure failure = failure_of(OutOfMemory("needs 3 GiB"));
  EXPECT_EQ(failure.message, "needs 3 GiB");
  tests::expect_message(failure.advice, {"limit"});
}

TEST(ExitCodes, OptionsAreFlagsAndArgumentsHaveNoDashes) {
  EXPECT_EQ(failure_of(BadOption({"max-depth", "x", "", "a number"})).message,
            "--max-depth: 'x' is not a number");
  EXPECT_EQ(failure_of(BadConfiguration({"hidden", "3", "", "16"})).message, "--hidden: '3' is not 16");
  EXPECT_EQ(failure_of(BadOption({"SCENE", "", "it is missing", "one"})).message,
            "SCENE: it is missing, expected one");
}

TEST(ExitCodes, ADivergedTrainingHasAdviceOfItsOwn) {
  tests::expect_message(failure_of(TrainingDiverged("m")).advice, {"--learning-rate"});
  tests::expect_message(failure_of(NumericalError("m")).advice, {"--nan drop"});
}

TEST(ExitCodes, TheLastLineIsOneLine) {
  ::testing::internal::CaptureStderr();
  print_failure({kInput, "first\nsecond", "do this"});
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "gatelight: error: first second; do this\n");
}

}  // namespace
}  // namespace gatelight::apps
