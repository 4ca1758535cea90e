#include "base/errors.h"

#include <gtest/gtest.h>

namespace gatelight {
namespace {

TEST(ErrorParts, MakeOneLine) {
  EXPECT_EQ(sentence({"spp", "x", "", "an integer from 1 to 5"}), "spp: 'x' is not an integer from 1 to 5");
  EXPECT_EQ(sentence({"spp", "", "", "an integer"}), "spp: '' is not an integer");
  EXPECT_EQ(sentence({"stack", "1,2,3", "has 3 levels", "at most 2"}),
            "stack: '1,2,3' has 3 levels, expected at most 2");
  EXPECT_EQ(sentence({"fps", "", "there are no frames", "`frames` or `turntable`"}),
            "fps: there are no frames, expected `frames` or `turntable`");
  EXPECT_EQ(sentence({"mis", "powr", "", "one of power|balance", "; did you mean 'power'?"}),
            "mis: 'powr' is not one of power|balance; did you mean 'power'?");
  EXPECT_EQ(sentence({"", "", "a mesh has no position", "one"}), "a mesh has no position, expected one");
}

TEST(ErrorParts, StayWithTheError) {
  const BadOption error({"spp", "x", "", "an integer"});
  EXPECT_EQ(error.kind(), ErrorKind::option);
  EXPECT_EQ(error.parts().option, "spp");
  EXPECT_EQ(error.parts().value, "x");
  EXPECT_EQ(error.parts().expected, "an integer");
  EXPECT_EQ(error.what(), sentence(error.parts()));
  EXPECT_EQ(InputError("no such file").parts().option, "");
}

}  // namespace
}  // namespace gatelight
