#include "renderer/settings/enum_names.h"

#include <gtest/gtest.h>

#include <cctype>
#include <string_view>

#include "apps/settings/parsing.h"

namespace gatelight::apps {
namespace {

using namespace renderer;

/// The compiler prints the name of an enumerator, and the number of a value that has none.
template <auto kValue>
constexpr bool is_enumerator() {
  const std::string_view name = __PRETTY_FUNCTION__;
  return name[name.find("kValue = ") + 9] != '(';
}

template <class Enumeration>
class EnumNames : public ::testing::Test {};

using Enumerations =
    ::testing::Types<Integrator, MisHeuristic, DirectLight, PixelFilter, NanPolicy, Aov, MatteKind,
                     SamplerKind, LightSelection, CachedComponent, QueryAt, CacheOutput, TrainingSource,
                     CachePreset, Tonemap, neural::FeatureEncoding, neural::ResolutionRule,
                     neural::NodeStorage, neural::Loss, neural::FeatureUpdate, neural::FeatureStep,
                     neural::FeaturePrecision>;
TYPED_TEST_SUITE(EnumNames, Enumerations);

TYPED_TEST(EnumNames, EachEnumeratorHasANameThatIsParsedBack) {
  constexpr auto& kTable = kEnumNames<TypeParam>;
  std::size_t i = 0;
  for (const Choice<TypeParam>& choice : kTable) {
    EXPECT_EQ(static_cast<std::size_t>(choice.value), i++) << choice.name;
    EXPECT_EQ(parse_choice("flag", enum_name(choice.value), kTable), choice.value);
  }
  EXPECT_FALSE(is_enumerator<static_cast<TypeParam>(std::size(kTable))>()) << "an enumerator has no name";
  EXPECT_TRUE(is_enumerator<static_cast<TypeParam>(std::size(kTable) - 1)>());
}

}  // namespace
}  // namespace gatelight::apps
