#include "renderer/fingerprint/deciding_options.h"

#include <gtest/gtest.h>

#include <functional>

#include "tests/support/messages.h"

namespace gatelight::renderer {
namespace {

using tests::expect_message;

std::string changed(const std::function<void(RenderOptions&, scene::Camera&)>& change,
                    Integrator integrator = Integrator::nrc) {
  RenderOptions options;
  options.integrator = integrator;
  scene::Camera camera;
  Metadata metadata;
  add_texts(metadata, "option", deciding_options(options, camera, {{"isa", "avx2"}}));
  change(options, camera);
  return list_differences(metadata, "option", deciding_options(options, camera, {{"isa", "avx2"}}));
}

/// The table of all options (apps/settings/picture_options_test.cpp) has no cameras.
TEST(DecidingOptions, AreNamedWithBothValuesAndSoIsTheCamera) {
  using O = RenderOptions&;
  using C = scene::Camera&;
  const std::vector<std::pair<std::function<void(O, C)>, tests::NameList>> cases = {
      {[](O o, C) { o.height = 541; }, {"size", "960x540", "960x541"}},
      {[](O o, C) {
         o.region = {{0, 1, 2, 3}};
       },
       {"region", "all", "0,1,2,3"}},
      {[](O o, C) {
         o.light_groups = {{"key", {"lamp*", "sun"}}};
       },
       {"light-groups", "none", "key=lamp*,sun"}},
      {[](O o, C) { o.cache.train_steps = 7; }, {"train-steps", "auto", "7"}},
      {[](O, C c) { c.transform(2, 3) = 1.0f; }, {"camera", "1,0,0,0,1,0,0,0,1,0,0,0"}},
      {[](O, C c) { c.vertical_fov = 1.25f; }, {"camera", "1.25"}},
      {[](O, C c) { c.orthographic = true; }, {"camera", "orthographic"}},
  };
  for (const auto& [change, names] : cases) expect_message(changed(change), names);
  EXPECT_EQ(changed([](O, C c) { c.name = "renamed"; }), "");
}

TEST(DecidingOptions, OptionsOfTheCacheDoNotDecideThePathTracersPicture) {
  const auto change = [](RenderOptions& o, scene::Camera&) { o.cache.batch = 7; };
  EXPECT_NE(changed(change, Integrator::nao), "");
  EXPECT_EQ(changed(change, Integrator::path), "");
}

}  // namespace
}  // namespace gatelight::renderer
