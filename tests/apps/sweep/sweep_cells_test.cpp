// The cells of a sweep: pictures, references, errors.

#include <set>

#include "renderer/image/image_read.h"
#include "tests/apps/sweep/sweep_test.h"
#include "tests/support/denoiser.h"

namespace gatelight::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class SweepCells : public SweepTest {};

/// Noise of the reference with this key.
double noise_of(const json& results, const std::string& id) {
  for (const json& reference : results["scenes"][0]["references"]) {
    if (reference["id"] == id) return reference["rel_mse_noise"];
  }
  ADD_FAILURE() << "there is no reference " << id;
  return 0.0;
}

TEST_F(SweepCells, MeasuresEveryCellAgainstItsReference) {
  const Output output =
      run_gatelight_inside(words("out", {"--encodings", "gate,hashgrid", "--cache-memory", "same-as-gate",
                                         "--seeds", "2", "--integrators", "nrc,nao"}));
  ASSERT_EQ(output.exit_code, 0) << output.err;
  EXPECT_EQ(output.out + output.err, "");
  const json all = results("out");
  // Two integrators by two encodings, path and ao: six lines with two points and two seeds each.
  ASSERT_EQ(all["cells"].size(), 24u);
  EXPECT_EQ(count(folder / "out/cells"), 24u);
  EXPECT_EQ(count(folder / "out/pictures"), 24u) << "a picture and a map of the first seed";
  std::map<std::string, std::set<std::size_t>> parameters;
  for (const json& cell : all["cells"]) {
    EXPECT_EQ(cell["status"], "done");
    EXPECT_GT(cell["errors"]["flip"], 0.0);
    EXPECT_LT(cell["errors"]["ssim"], 1.0);
    EXPECT_NEAR(cell["errors"]["rel_mse"].get<double>() - cell["errors"]["rel_mse_clean"].get<double>(),
                noise_of(all, cell["reference_id"]), 1e-12);
    EXPECT_GT(cell["seconds"]["total"], 0.0);
    EXPECT_EQ(cell["picture"].is_null(), cell["seed"] != 1);
    EXPECT_EQ(cell["errors"]["hdr_flip"].is_null(), cell["reference"] == "ao");
    if (cell["encoding"].is_string()) {
      const std::size_t bytes = cell["memory_bytes"]["parameters"];
      parameters[cell["integrator"].get<std::string>()].insert(bytes);
      if (cell["encoding"] == "hashgrid") {
        EXPECT_GT(cell["options"]["cache-memory"], 0.0);
      }
    }
    if (!cell["picture"].is_null()) {
      EXPECT_EQ(renderer::read_image(folder / ("out/" + cell["picture"].get<std::string>())).width, 24);
      EXPECT_EQ(renderer::read_image(folder / ("out/" + cell["error_map"].get<std::string>())).width, 24);
    }
    EXPECT_EQ(cell["options"]["isa"], cell["isa"]);
    if (cell["reference"] != "path" || cell["encoding"] == "hashgrid") continue;
    for (const auto& [option, value] : cell["options"].items())
      EXPECT_TRUE(value != "auto" || option == "cluster" || option == "environment") << option;
  }
  // As near as the sizes of tables allow.
  for (const auto& [integrator, bytes] : parameters) {
    EXPECT_LT(static_cast<double>(*bytes.rbegin()), 1.3 * static_cast<double>(*bytes.begin())) << integrator;
  }
  ASSERT_EQ(all["scenes"].size(), 1u);
  EXPECT_EQ(all["scenes"][0]["name"], "cornell-box");
  ASSERT_EQ(all["scenes"][0]["references"].size(), 2u);
  for (const json& reference : all["scenes"][0]["references"]) {
    EXPECT_GT(reference["rel_mse_noise"], 0.0);
    EXPECT_EQ(reference["spp"], 8);
    EXPECT_TRUE(fs::exists(folder / ("out/" + reference["file"].get<std::string>())));
  }
  EXPECT_EQ(std::count(all["command"].begin(), all["command"].end(), "sweep"), 1);
  const std::string report = read_file(folder / "out/report.html");
  std::size_t shown = 0;
  for (std::size_t at = 0; (at = report.find("src=\"data:image/jpeg", at)) != std::string::npos; ++at)
    ++shown;
  EXPECT_EQ(shown, 24u + 2u) << "pictures and FLIP maps of the first seed, and the references";
  EXPECT_THAT(report, ::testing::Not(HasSubstr("no picture")));
}

TEST_F(SweepCells, ACellIsThePictureThatItsCommandMakes) {
  const json all = swept("out", {"--features", "2,4"});
  for (const json& cell : all["cells"]) {
    ASSERT_NO_FATAL_FAILURE(expect_picture_of_its_command(cell));
  }
}

/// A sweep by default measures the bare and the finished cache beside path tracing of both kinds.
TEST_F(SweepCells, OfASceneAloneAreTheFinishedPicturesThatTheCommandsMake) {
  GATELIGHT_NEEDS_DENOISER();
  Words call = words("out", {});
  const auto denoiser = std::find(call.begin(), call.end(), "--denoiser");
  call.erase(denoiser, denoiser + 2);
  const Output output = run_gatelight_inside(call);
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const json all = results("out");
  std::map<std::string, int> cells;
  for (const json& cell : all["cells"]) {
    ++cells[cell["series"].get<std::string>()];
    const bool finished = cell["options"]["denoiser"] == "oidn";
    EXPECT_EQ(cell["axes"]["denoiser"], finished ? "oidn" : "none");
    EXPECT_EQ(cell["seconds"]["denoise"].is_number(), finished);
    const json& seconds = cell["seconds"];
    double sum = 0.0;
    for (const char* phase : {"scout", "setup", "train", "render", "denoise"}) {
      if (seconds[phase].is_number()) sum += seconds[phase].get<double>();
    }
    EXPECT_NEAR(seconds["total"].get<double>(), sum, 1e-9);
    EXPECT_EQ(cell["reference_id"], all["scenes"][0]["references"][0]["id"]);
    if (cell["series"] == "nrc bare" || (cell["series"] == "path" && cell["spp"] == 1)) continue;
    ASSERT_NO_FATAL_FAILURE(expect_picture_of_its_command(cell));
  }
  EXPECT_EQ(cells, (std::map<std::string, int>{{"path", 2},
                                               {"path denoised", 2},
                                               {"nrc bare", 2},
                                               {"nrc standard spp 2", 2},
                                               {"nrc standard spp 7", 2},
                                               {"nrc standard spp 28", 2}}));
  EXPECT_THAT(read_file(folder / "out/results.csv"), HasSubstr("axis_denoiser"));
}

TEST_F(SweepCells, AGivenReferenceIsCompared) {
  ASSERT_EQ(run_gatelight_inside({"render", cornell(), "-o", path("r.exr"), "--size", "24x16", "--spp", "16",
                                  "--seed", "77", "--quiet"})
                .exit_code,
            0);
  const json all = swept("out", {"--reference", path("r.exr"), "--no-plain"});
  EXPECT_EQ(all["cells"].size(), 2u);
  EXPECT_TRUE(all["cells"][0]["errors"]["rel_mse_clean"].is_null());
  EXPECT_EQ(all["scenes"][0]["references"][0]["file"], path("r.exr"));
  EXPECT_EQ(all["scenes"][0]["references"][0]["spp"], 16);
  EXPECT_FALSE(fs::exists(folder / "out/references"));
  EXPECT_EQ(all["cells"][0]["reference_id"], all["scenes"][0]["references"][0]["id"]);
  // A reference that fits no cell is reported before the first cell is made.
  const auto refused = [&](const Words& more) {
    Words flags = {"--reference", path("r.exr"), "--no-plain"};
    flags.insert(flags.end(), more.begin(), more.end());
    const Output output = run_gatelight_inside(words("other", flags));
    EXPECT_NE(output.exit_code, 0);
    EXPECT_EQ(count(folder / "other/cells"), 0u);
    return output;
  };
  const Output size = refused({"--size", "20x16"});
  expect_failure(size, 2, {"r.exr", "24x16", "20x16"});
  for (const char* vary : {"max-depth=2,3", "filter=box,tent", "environment=none;1,1,1", "fov=40,50"}) {
    const Output views = refused({"--vary", vary});
    expect_failure(views, 1, {"--reference", path("r.exr"), "2", "reference-spp"});
  }
  const Output missing = run_gatelight_inside(words("out", {"--reference", path("none.exr"), "--no-plain"}));
  expect_failure(missing, 2, {"none.exr"});
}

TEST_F(SweepCells, NamedRunsAreMeasuredWithTheirBias) {
  Words call = words("out", {"--run", "cached: --integrator nrc --query-at primary --train-steps 8", "--run",
                             "two: --spp 2", "--keep-exr", "--seeds", "2", "--reference-spp", "256"});
  const auto steps = std::find(call.begin(), call.end(), "--train-steps");
  call.erase(steps, steps + 2);
  const Output output = run_gatelight_inside(call);
  ASSERT_EQ(output.exit_code, 0) << output.err;
  const json all = results("out");
  std::map<std::string, json> second;
  for (const json& cell : all["cells"]) {
    EXPECT_TRUE(fs::exists(folder / ("out/pictures/" + cell["id"].get<std::string>() + ".exr")));
    EXPECT_EQ(cell["errors"]["bias_rel_mse"].is_null(), cell["seed"] == 1);
    if (cell["seed"] == 2) second[cell["run"].get<std::string>()] = cell;
    if (cell["seed"] == 1) {
      ASSERT_NO_FATAL_FAILURE(expect_picture_of_its_command(cell));
    }
  }
  ASSERT_EQ(second.size(), 4u) << "path with 1 and 4 samples, and the runs";
  const auto error = [&](const char* run, const char* key) {
    return second.at(run)["errors"][key].get<double>();
  };
  // A cache of eight steps is biased, and paths are not.
  EXPECT_GT(error("cached", "bias_rel_mse"), 0.5 * error("cached", "rel_mse_clean"));
  EXPECT_LT(std::abs(error("path, 4 spp", "bias_rel_mse")), 0.5 * error("path, 4 spp", "rel_mse_clean"));
  EXPECT_GT(error("path, 1 spp", "rel_mse_clean"), error("two", "rel_mse_clean"));
  EXPECT_GT(error("two", "rel_mse_clean"), error("path, 4 spp", "rel_mse_clean"));
  EXPECT_EQ(second.at("cached")["train_steps"], 8);
  // The bias is that of `compare --halves`.
  const std::string reference =
      path("out/references/" + all["scenes"][0]["references"][0]["id"].get<std::string>());
  const auto exr = [&](const json& cell) {
    return path("out/pictures/" + cell["id"].get<std::string>() + ".exr");
  };
  std::string first;
  for (const json& cell : all["cells"]) {
    if (cell["run"] == "cached" && cell["seed"] == 1) first = exr(cell);
  }
  const Output compared =
      run_gatelight_inside({"compare", reference + "_a.exr", first, "--halves", reference + "_b.exr",
                            exr(second.at("cached")), "--json", "-", "--metric", "rel_mse"});
  EXPECT_NEAR(json::parse(compared.out)["bias_rel_mse"].get<double>(), error("cached", "bias_rel_mse"),
              1e-12);
  EXPECT_THAT(read_file(folder / "out/results.md"),
              AllOf(HasSubstr("| | cached | two |\n"), HasSubstr("|  | cached | ")));
  // Nothing is made again, except a pair whose picture is missing.
  const auto before = times_of({folder / "out/cells", folder / "out/pictures"});
  ASSERT_EQ(run_gatelight_inside(call).exit_code, 0);
  EXPECT_EQ(times_of({folder / "out/cells", folder / "out/pictures"}), before);
  fs::remove(first);
  ASSERT_EQ(run_gatelight_inside(call).exit_code, 0);
  EXPECT_TRUE(fs::exists(first));
  EXPECT_EQ(without_seconds(results("out"))["cells"].size(), all["cells"].size());
  // The same reference from elsewhere, as its halves.
  Words given = call;
  given[3] = path("given");
  given.insert(given.end(), {"--reference", reference + "_a.exr", "--reference", reference + "_b.exr"});
  ASSERT_EQ(run_gatelight_inside(given).exit_code, 0);
  const json again = results("given");
  for (std::size_t i = 0; i < all["cells"].size(); ++i)
    EXPECT_EQ(again["cells"][i]["errors"], all["cells"][i]["errors"]);
}

TEST_F(SweepCells, SweepsMayShareAFolderOfReferences) {
  const Words shared = {"--reference-dir", path("shared"), "--no-plain"};
  swept("a", shared);
  ASSERT_EQ(count(folder / "shared"), 4u);
  const std::string file = results("a")["scenes"][0]["references"][0]["file"];
  EXPECT_EQ(fs::path(file).parent_path(), folder / "shared");
  const auto time = fs::last_write_time(file);
  swept("b", shared);
  EXPECT_EQ(fs::last_write_time(file), time);
  EXPECT_EQ(without_seconds(results("a")), without_seconds(results("b")));
}

TEST_F(SweepCells, TheBareCacheIsComparedWithWhatItShouldAnswer) {
  const json all = swept("out", {"--preset", "paper-nrc", "--train-steps", "8", "--batch", "1024"});
  ASSERT_EQ(all["cells"].size(), 1u);
  EXPECT_EQ(all["cells"][0]["reference"], "cache");
  EXPECT_EQ(all["scenes"][0]["references"][0]["kind"], "cache");
  EXPECT_LT(all["cells"][0]["errors"]["flip"], 0.9);
}

}  // namespace
}  // namespace gatelight::tests
