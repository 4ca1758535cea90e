#include "renderer/metrics/merge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "tests/support/messages.h"

namespace gatelight::renderer {
namespace {

using ::testing::ElementsAre;
using Metadata = std::map<std::string, std::string>;
using tests::expect_message;

Picture picture(std::vector<float> values, Metadata metadata = {}) {
  Picture p{.width = 1, .height = 1, .full_width = 1, .full_height = 1, .metadata = std::move(metadata)};
  p.layers = {{.channels = {"R", "G", "B"}, .values = std::move(values)}};
  return p;
}

Picture merge(const Picture& a, const Picture& b) {
  return merge_pictures({{a, "a.exr"}, {b, "b.exr"}});
}

TEST(Merge, WeighsBySamplesPerPixel) {
  const Picture m = merge(picture({1, 2, 3}, {{"spp", "1"}}), picture({5, 2, 7}, {{"spp", "3"}}));
  EXPECT_THAT(m.layers[0].values, ElementsAre(4, 2, 6));
  EXPECT_TRUE(m.layers[0].full_precision);
  EXPECT_EQ(m.metadata.at("spp"), "4");
}

TEST(Merge, WithoutSamplesPerPixelEachCountsTheSame) {
  const Picture m = merge(picture({1, 2, 3}), picture({5, 2, 7}));
  EXPECT_THAT(m.layers[0].values, ElementsAre(3, 2, 5));
  EXPECT_FALSE(m.metadata.contains("spp"));
}

TEST(Merge, MergesOfMergesEqualOneMerge) {
  const Picture a = picture({1, 2, 3}, {{"spp", "8"}});
  const Picture b = picture({5, 0, 7}, {{"spp", "8"}});
  const Picture c = picture({0, 4, 1}, {{"spp", "16"}});
  const Picture once = merge_pictures({{a, "a"}, {b, "b"}, {c, "c"}});
  const Picture ab = merge(a, b);
  const Picture twice = merge(ab, c);
  EXPECT_EQ(once.layers[0].values, twice.layers[0].values);
  EXPECT_EQ(once.metadata, twice.metadata);
}

TEST(Merge, CryptomattesAreThoseOfTheFirst) {
  Picture a = picture({0, 0, 0}, {{"spp", "1"}}), b = a;
  for (Picture* p : {&a, &b}) {
    p->layers.push_back({.name = "CryptoObject00", .channels = {"R", "G", "B", "A"}, .values = {7, 1, 0, 0}});
    p->attributes = {{"cryptomatte/1234567/name", "CryptoObject"}};
  }
  b.layers[1].values = {-9, 0.5, 7, 0.5};
  const Picture m = merge(a, b);
  EXPECT_THAT(m.layers[1].values, ElementsAre(7, 1, 0, 0));
  EXPECT_EQ(m.attributes, a.attributes);
}

TEST(Merge, LayersFollowTheirMeaning) {
  Picture a = picture({0, 0, 0}, {{"spp", "1"}});
  Picture b = picture({0, 0, 0}, {{"spp", "3"}});
  a.layers.push_back({.name = "samples", .channels = {"count"}, .values = {1}});
  b.layers.push_back({.name = "samples", .channels = {"count"}, .values = {3}});
  a.layers.push_back({.name = "instance", .channels = {"id"}, .values = {7}});
  b.layers.push_back({.name = "instance", .channels = {"id"}, .values = {9}});
  a.layers.push_back({.name = "variance", .channels = {"R", "G", "B"}, .values = {16, 0, 0}});
  a.layers.push_back({.name = "error", .channels = {"R", "G", "B"}, .values = {4, 0, 4}});
  b.layers.push_back({.name = "variance", .channels = {"R", "G", "B"}, .values = {0, 16, 16}});
  b.layers.push_back({.name = "error", .channels = {"R", "G", "B"}, .values = {0, 4, 4}});
  a.layers.push_back({.name = "depth", .channels = {"Z"}, .values = {4}});
  b.layers.push_back({.name = "depth", .channels = {"Z"}, .values = {8}});
  const Picture m = merge(a, b);
  EXPECT_THAT(m.find("samples")->values, ElementsAre(4));
  EXPECT_THAT(m.find("instance")->values, ElementsAre(7));
  EXPECT_THAT(m.find("variance")->values, ElementsAre(1, 9, 9)) << "variance of (a + 3 b) / 4";
  EXPECT_THAT(m.find("error")->values, ElementsAre(1, 3, ::testing::FloatEq(std::sqrt(10.0f))));
  EXPECT_THAT(m.find("depth")->values, ElementsAre(7));
}

TEST(Merge, MetadataKeepsWhatAllHaveInCommon) {
  const Picture a = picture({1, 2, 3}, {{"spp", "1"}, {"seed", "1"}, {"scene", "x.glb"}, {"seconds", "1.0"}});
  const Picture b = picture({1, 2, 3}, {{"spp", "1"}, {"seed", "2"}, {"scene", "x.glb"}, {"seconds", "2.0"}});
  const Metadata expected = {{"spp", "2"}, {"seed", "1,2"}, {"scene", "x.glb"}};
  EXPECT_EQ(merge(a, b).metadata, expected);
  EXPECT_FALSE(merge(a, picture({1, 2, 3}, {{"spp", "1"}})).metadata.contains("seed"));
}

std::string refusal_to_merge(const Picture& a, const Picture& b) {
  return tests::refusal<InputError>([&] { merge(a, b); });
}

TEST(Merge, RefusesMismatchesByName) {
  const Picture a = picture({1, 2, 3}, {{"spp", "1"}});
  Picture wide = a;
  wide.width = 2;
  wide.layers[0].values.resize(6);
  expect_message(refusal_to_merge(a, wide), {"a.exr", "1x1", "b.exr", "2x1"});
  Picture elsewhere = a;
  elsewhere.x0 = 4;
  expect_message(refusal_to_merge(a, elsewhere), {"4,0"});
  Picture more = a;
  more.layers.push_back({.name = "depth", .channels = {"Z"}, .values = {1}});
  expect_message(refusal_to_merge(a, more), {"depth(Z)"});
  expect_message(refusal_to_merge(a, picture({1, 2, 3})), {"b.exr"});
  expect_message(refusal_to_merge(picture({1, 2, 3}), a), {"a.exr"});
  for (const char* spp : {"0", "many", "-4", "4x"}) {
    expect_message(refusal_to_merge(a, picture({1, 2, 3}, {{"spp", spp}})), {"b.exr", spp});
  }
}

TEST(Merge, RefusesPartsOfOtherPicturesAndOtherIntegrators) {
  const Picture a = picture({1, 2, 3}, {{"integrator", "path"}});
  Picture part = a;
  part.full_width = 4;
  expect_message(refusal_to_merge(a, part), {"1x1", "4x1"});
  const Picture other = picture({1, 2, 3}, {{"integrator", "ao"}});
  expect_message(refusal_to_merge(a, other), {"a.exr", "path", "ao"});
  EXPECT_EQ(refusal_to_merge(a, picture({1, 2, 3})), "") << "not every program writes its integrator";
}

TEST(Merge, CountsAndSumsDoNotOverflow) {
  const Picture many = picture({1, 2, 3}, {{"spp", "18446744073709551615"}});
  expect_message(refusal_to_merge(many, picture({1, 2, 3}, {{"spp", "1"}})), {"b.exr", "64"});
  Picture counted = picture({1, 2, 3});
  counted.layers.push_back({.name = "samples", .channels = {"count"}, .values = {3e38f}});
  EXPECT_THAT(merge(counted, counted).find("samples")->values,
              ElementsAre(std::numeric_limits<float>::max()));
}

}  // namespace
}  // namespace gatelight::renderer
