// References: sharing between cells, their noise, and stopping.

#include "apps/sweep/references.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/reports/compare_report.h"
#include "apps/sweep/gate_memory.h"
#include "apps/sweep/identity.h"
#include "apps/terminal/errors.h"
#include "renderer/cache/cache_report.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "renderer/metrics/compare.h"
#include "renderer/render.h"
#include "renderer/settings/presets.h"
#include "renderer/surface/embree.h"
#include "scene/gltf.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::apps {
namespace {

namespace fs = std::filesystem;
using renderer::Integrator;
using renderer::Picture;
using ::testing::HasSubstr;
using tests::expect_refusal;
using tests::TemporaryFolder;

class SweepReferences : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = new scene::Scene(scene::load_gltf(GATELIGHT_SOURCE_DIR "/data/cornell-box.glb"));
  }
  static void TearDownTestSuite() { delete scene_; }

  static RenderSettings settings(Integrator integrator) {
    RenderSettings s;
    s.scene = "cornell-box.glb";
    s.render.integrator = integrator;
    s.render.width = 24;
    s.render.height = 16;
    return s;
  }
  static const renderer::SceneFingerprint& fingerprint() {
    static const renderer::SceneFingerprint print = renderer::compute_scene_fingerprint(*scene_, {});
    return print;
  }
  Reference plan(const RenderSettings& s, ReferenceKind kind, int spp = 16) const {
    return plan_reference(s, kind, *scene_, fingerprint(), spp, folder.path().string());
  }

  static scene::Scene* scene_;
  TemporaryFolder folder;
};

scene::Scene* SweepReferences::scene_ = nullptr;

TEST_F(SweepReferences, AreSharedByCellsThatEstimateTheSame) {
  const RenderSettings cell = settings(Integrator::nrc);
  const std::string key = plan(cell, ReferenceKind::path).key;
  std::vector<RenderSettings> same(9, cell);
  same[0].render.integrator = Integrator::path;
  same[1].render.clamp = 2.0f;
  same[2].render.sampler = renderer::SamplerKind::independent;
  same[3].render.cache.gate.features = 8;
  same[4].render.seed = 9;
  same[5].render.threads = 3;
  same[6].image.display.exposure = 1.0f;
  same[7].render.ao_distance = 1.0f;
  same[8].render.isa = "scalar";
  for (const RenderSettings& other : same) EXPECT_EQ(plan(other, ReferenceKind::path).key, key);
  std::vector<RenderSettings> different(4, cell);
  different[0].render.max_depth = 3;
  different[1].render.width = 25;
  different[2].render.filter = renderer::PixelFilter::box;
  different[3].render.camera.look_at = renderer::LookAt{};
  for (const RenderSettings& other : different) EXPECT_NE(plan(other, ReferenceKind::path).key, key);
  EXPECT_NE(plan(cell, ReferenceKind::path, 32).key, key);
  EXPECT_NE(plan(cell, ReferenceKind::ao).key, key);
  RenderSettings reach = cell;
  reach.render.ao_distance = 1.0f;
  EXPECT_NE(plan(reach, ReferenceKind::ao).key, plan(cell, ReferenceKind::ao).key);
  // What the cache stores is what it should answer. It matters only to the bare view.
  RenderSettings holds = cell;
  holds.render.cache.component = renderer::CachedComponent::all;
  EXPECT_EQ(plan(holds, ReferenceKind::path).key, key);
  EXPECT_NE(plan(holds, ReferenceKind::cache).key, plan(cell, ReferenceKind::cache).key);
}

TEST_F(SweepReferences, EstimateTheirNoiseFromTheirHalves) {
  for (const ReferenceKind kind : {ReferenceKind::path, ReferenceKind::ao, ReferenceKind::cache}) {
    const RenderSettings cell = settings(kind == ReferenceKind::ao ? Integrator::nao : Integrator::nrc);
    Reference reference = plan(cell, kind);
    const Picture mean = *make_reference(reference, *scene_, cell, {});
    const Picture a = renderer::read_image(folder / (reference.key + "_a.exr"));
    const Picture b = renderer::read_image(folder / (reference.key + "_b.exr"));
    EXPECT_NE(a.layers[0].values, b.layers[0].values);
    EXPECT_EQ(mean.metadata.at("spp"), "16");
    double noise = 0.0;
    const std::size_t count = mean.layers[0].values.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double half = 0.5 * (a.layers[0].values[i] - b.layers[0].values[i]);
      const double m = mean.layers[0].values[i];
      noise += half * half / (m * m + 0.01) / static_cast<double>(count);
    }
    ASSERT_TRUE(reference.rel_mse_noise.has_value());
    EXPECT_GT(noise, 0.0);
    EXPECT_NEAR(*reference.rel_mse_noise, noise, 1e-5 * noise);
    // Read, not rendered, the second time.
    Reference again = plan(cell, kind);
    renderer::Callbacks never;
    never.progress = [](const renderer::Progress&) { ADD_FAILURE() << "it renders"; };
    EXPECT_EQ(make_reference(again, *scene_, cell, never)->layers[0].values, mean.layers[0].values);
    EXPECT_EQ(again.rel_mse_noise, reference.rel_mse_noise);
    EXPECT_EQ(again.seconds, reference.seconds);
  }
}

TEST_F(SweepReferences, OfANamedRunDoNotChooseTheirIntegratorAndSamples) {
  RenderSettings cell = settings(Integrator::nrc);
  renderer::apply_preset(renderer::CachePreset::preview, cell.render);
  ASSERT_TRUE(cell.render.choose_integrator);
  Reference reference = plan(cell, ReferenceKind::path);
  EXPECT_EQ(reference.key, plan(settings(Integrator::path), ReferenceKind::path).key);
  const Picture mean = *make_reference(reference, *scene_, cell, {});
  EXPECT_EQ(mean.metadata.at("spp"), "16");
  EXPECT_EQ(mean.metadata.at("integrator"), "path");
}

TEST_F(SweepReferences, RepeatedStopsDoNotChangeTheirBits) {
  const RenderSettings cell = settings(Integrator::path);
  Reference reference = plan(cell, ReferenceKind::path);
  const Picture straight = *make_reference(reference, *scene_, cell, {});
  const TemporaryFolder other;
  Reference stopped =
      plan_reference(cell, ReferenceKind::path, *scene_, fingerprint(), 16, other.path().string());
  renderer::Callbacks callbacks;
  callbacks.stop = [] { return true; };
  int calls = 0;
  std::optional<Picture> picture;
  while (!(picture = make_reference(stopped, *scene_, cell, callbacks)) && ++calls < 100) {
  }
  EXPECT_GT(calls, 2) << "each call is one pass";
  ASSERT_TRUE(picture.has_value());
  EXPECT_EQ(picture->layers[0].values, straight.layers[0].values);
  EXPECT_EQ(other.count_files(), 4u) << "two halves, their mean and its numbers";
}

TEST_F(SweepReferences, UnreadableOnesAreRenderedAgain) {
  const RenderSettings cell = settings(Integrator::path);
  Reference reference = plan(cell, ReferenceKind::path);
  const Picture whole = *make_reference(reference, *scene_, cell, {});
  const auto again = [&] {
    Reference damaged = plan(cell, ReferenceKind::path);
    const Picture picture = *make_reference(damaged, *scene_, cell, {});
    EXPECT_EQ(damaged.rel_mse_noise, reference.rel_mse_noise);
    return picture.layers[0].values;
  };
  const std::string half = tests::read_file(folder / (reference.key + "_a.exr"));
  folder.write(reference.key + "_a.exr", half.substr(0, half.size() / 2));
  folder.write(reference.key + "_a.checkpoint", "not a checkpoint");
  folder.write(reference.key + ".json", "{");
  EXPECT_EQ(again(), whole.layers[0].values) << "a half, its checkpoint, and the numbers of the mean";
  folder.write(reference.key + ".exr", "no picture");
  folder.write(reference.key + "_b.exr", "");
  EXPECT_EQ(again(), whole.layers[0].values) << "the mean and the other half";
  EXPECT_EQ(folder.count_files(), 4u);
}

TEST_F(SweepReferences, GivenOnesAreIdentifiedByTheirPixelsAndHalvesHaveAMeanItsNoiseAndTheBiasOfAPair) {
  const auto write = [&](const char* name, float value) {
    Picture picture{.width = 1, .height = 1, .metadata = {{"spp", "7"}}};
    picture.layers = {{.channels = {"R", "G", "B"}, .values = {value, value, value}}};
    const std::string file = (folder / name).string();
    renderer::write_image(picture, file, {.exr_float = true});
    return file;
  };
  renderer::RenderOptions cell;
  cell.width = cell.height = 1;
  const auto given = [&](const std::vector<std::string>& files) {
    return given_reference(ReferenceKind::path, files, cell);
  };
  const Reference one = given({write("r.exr", 1.0f)});
  EXPECT_EQ(one.spp, 7);
  EXPECT_FALSE(one.rel_mse_noise.has_value());
  EXPECT_NE(given({write("r.exr", 1.5f)}).key, one.key);
  Reference both = given({write("a.exr", 1.0f), write("b.exr", 3.0f)});
  EXPECT_EQ(both.spp, 14);
  EXPECT_NEAR(*both.rel_mse_noise, 1.0 / 4.01, 1e-9);
  const Picture mean = *make_reference(both, *scene_, settings(Integrator::path), {});
  EXPECT_EQ(mean.layers[0].values[0], 2.0f);
  // (1.5 - 1) (4 - 3) over the square of the mean.
  const std::string second = write("second.exr", 4.0f);
  EXPECT_NEAR(measure_bias(both, write("first.exr", 1.5f), {renderer::read_image(second), second}),
              0.5 / 4.01, 1e-9);
}

TEST_F(SweepReferences, AGivenReferenceFitsTheCellsOrIsRefused) {
  const std::string file = (folder / "r.exr").string();
  const auto give = [&](const Picture& picture, const renderer::RenderOptions& cell) {
    renderer::write_image(picture, file, {.exr_float = true});
    given_reference(ReferenceKind::path, {file}, cell);
  };
  renderer::RenderOptions cell;
  cell.width = 3;
  cell.height = 2;
  Picture picture{.width = 2, .height = 2};
  picture.layers = {{.channels = {"R", "G", "B"}, .values = std::vector<float>(12, 1.0f)}};
  expect_refusal<InputError>([&] { give(picture, cell); }, {file, "2x2", "3x2"});
  cell.region = std::array{1, 0, 3, 2};
  EXPECT_NO_THROW(give(picture, cell));
  Picture grey = picture;
  grey.layers = {{.channels = {"Y"}, .values = std::vector<float>(4, 1.0f)}};
  expect_refusal<InputError>([&] { give(grey, cell); }, {file});
  Picture depth = picture;
  depth.layers = {{.name = "depth", .channels = {"Z"}, .values = std::vector<float>(4, 1.0f)}};
  expect_refusal<InputError>([&] { give(depth, cell); }, {file});
  picture.layers[0].values[5] = std::nanf("");
  expect_refusal<InputError>([&] { give(picture, cell); }, {file, "1"});
}

TEST_F(SweepReferences, NamesAreRelativeWithinTheFolderAndAbsoluteOutside) {
  const Reference inside{.key = "k", .file = "/a/b/references/k.exr"};
  EXPECT_EQ(reference_json(inside, "/a/b")["id"], "k");
  EXPECT_EQ(reference_json(inside, "/a/b")["file"], "references/k.exr");
  EXPECT_EQ(reference_json(inside, "/a/c/")["file"], "/a/b/references/k.exr");
  // Another file of this name may lie in the sweep's folder.
  const Reference given{.key = "k", .file = "r.exr", .given = true};
  EXPECT_EQ(reference_json(given, "/a/b")["file"], (fs::current_path() / "r.exr").string());
}

TEST_F(SweepReferences, MemoryOfGateIsThatOfItsFeaturesAndIsStored) {
  renderer::RenderOptions options = settings(Integrator::nrc).render;
  options.cache.gate.features = 3;
  const std::string file = (folder / "memory.json").string();
  const std::uint64_t bytes = gate_memory(file, "k", *scene_, options);
  const renderer::CacheReport report = renderer::Renderer(*scene_, options).report_cache();
  EXPECT_EQ(bytes, report.statistics.nodes * 3 * 4);
  EXPECT_LE(bytes, report.statistics.parameter_bytes);
  EXPECT_GT(bytes + 64 * 1024, report.statistics.parameter_bytes) << "the network is small";
  // Another key is another cache; the memory of a stored key is not computed again.
  options.cache.gate.features = 1;
  EXPECT_EQ(gate_memory(file, "k", *scene_, options), bytes);
  EXPECT_LT(gate_memory(file, "other", *scene_, options), bytes);
}

TEST_F(SweepReferences, HdrFlipOfACellCanBeStopped) {
  Picture bright{.width = 4, .height = 1};
  bright.layers = {{.channels = {"R", "G", "B"}, .values = {9, 9, 9, 1, 1, 1, 1, 1, 1, 1, 1, 1}}};
  Picture other = bright;
  other.layers[0].values[0] = 1.0f;
  CompareReport report{.metrics = {Metric::hdr_flip}};
  int calls = 0;
  const auto measure = [&](int most) {
    calls = 0;
    return measure_looks(report, {bright, "a"}, {other, "b"}, false, [&](double) { return ++calls <= most; });
  };
  EXPECT_TRUE(measure(100));
  EXPECT_GT(calls, 2);
  EXPECT_FALSE(measure(1));
  EXPECT_EQ(calls, 2);
}

TEST_F(SweepReferences, CellsOfOtherMachinesHaveOtherNames) {
  const std::string name = identity_name(fingerprint(), {"text", "cpu a"});
  EXPECT_EQ(identity_name(fingerprint(), {"text", "cpu a"}), name);
  EXPECT_NE(identity_name(fingerprint(), {"text", "cpu b"}), name);
  EXPECT_NE(identity_name(fingerprint(), {"textcpu a", ""}), name);
  renderer::RenderOptions options;
  const std::string fastest = machine_text(options);
  EXPECT_THAT(fastest, HasSubstr(cpu_name()));
  options.isa = renderer::best_isa();
  EXPECT_EQ(machine_text(options), fastest) << "the chosen instruction set counts, not how it was chosen";
  options.integrator = Integrator::nrc;
  const std::string kernels = machine_text(options);
  EXPECT_NE(kernels, fastest);
  options.isa = "scalar";
  EXPECT_NE(machine_text(options), kernels);
}

}  // namespace
}  // namespace gatelight::apps
