// The search for the library, and the files that are refused. tests/support/stand_in_oidn.cpp is a library
// with the names of Open Image Denoise, in the version of its file name.

#include "renderer/denoise/oidn_library.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <string>

#include "base/errors.h"
#include "renderer/driver/chosen_denoiser.h"
#include "tests/support/denoiser.h"
#include "tests/support/environment_variable.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/thread_ranks.h"

namespace gatelight::renderer {
namespace {

namespace fs = std::filesystem;
using tests::expect_refusal;
using tests::TemporaryFolder;

constexpr const char* kFile = "libOpenImageDenoise.so.2";

TEST(OidnLibrary, AFileOrAFolderIsLoadedAndNothingElse) {
  const TemporaryFolder folder;
  fs::copy(GATELIGHT_STAND_IN_OIDN_2, folder / kFile);
  EXPECT_EQ(load_oidn(folder.path().string()).version, "2.7.1");
  EXPECT_EQ(load_oidn((folder / kFile).string()).path, (folder / kFile).string());
  EXPECT_EQ(&load_oidn(folder.path().string()), &load_oidn(folder.path().string())) << "once";
  expect_refusal<MissingDenoiser>([&] { load_oidn((folder / "none").string()); },
                                  {"Open Image Denoise", "none"});
}

TEST(OidnLibrary, TheNewestOneOfTheCacheFolderTakesPrecedence) {
  const TemporaryFolder cache;
  for (const char* const name : {"oidn-2.4.0", "oidn-2.5.1"}) {
    fs::create_directories(cache / "gatelight" / name / "lib");
    fs::copy(GATELIGHT_STAND_IN_OIDN_2, cache / "gatelight" / name / "lib" / kFile);
  }
  const tests::EnvironmentVariable home("XDG_CACHE_HOME", cache.path().string());
  // The search itself is not remembered for other tests: this process has its own cache folder now.
  EXPECT_EQ(find_oidn_file(""), (cache / "gatelight/oidn-2.5.1/lib" / kFile).string());
  EXPECT_EQ(find_oidn_file("/a/b.so"), "/a/b.so");
}

TEST(OidnLibrary, OtherVersionsAndOtherLibrariesAreRefusedByName) {
  expect_refusal<MissingDenoiser>([&] { load_oidn(GATELIGHT_STAND_IN_OIDN_1); }, {"1.4.3", "version 2"});
  const TemporaryFolder folder;
  const std::string text = folder.write("text.so.2", "no library");
  expect_refusal<MissingDenoiser>([&] { load_oidn(text); }, {"text.so.2"});
  expect_refusal<MissingDenoiser>([&] { load_oidn("libm.so.6"); }, {"libm.so.6", "oidnNewDevice"});
}

TEST(ChosenDenoiser, IsNoneWhereItIsMissingUnlessItIsRequested) {
  RenderOptions options;
  options.denoise = {.supersampling = 2, .library = "/none/libOpenImageDenoise.so.2"};
  EXPECT_EQ(choose_denoiser(options).library, nullptr) << "there is no search";
  options.denoise.denoiser = DenoiserKind::oidn;
  expect_refusal<MissingDenoiser>([&] { choose_denoiser(options); }, {"/none"});
  options.denoise.denoiser = DenoiserKind::automatic;
  const ChosenDenoiser none = choose_denoiser(options);
  EXPECT_EQ(none.library, nullptr);
  EXPECT_NE(none.missing.find("/none"), std::string::npos);
  RenderOptions render = with_denoiser(options, none);
  EXPECT_EQ(render.denoise.denoiser, DenoiserKind::none);
  EXPECT_EQ(render.denoise.supersampling, 1);
  options.denoise.library = GATELIGHT_STAND_IN_OIDN_2;
  render = with_denoiser(options, choose_denoiser(options));
  EXPECT_EQ(render.denoise.denoiser, DenoiserKind::oidn);
  EXPECT_EQ(render.denoise.supersampling, 2);
  render.spp = 3;
  EXPECT_EQ(with_denoiser(render, choose_denoiser(options)).denoise.supersampling, 1);
}

TEST(ChosenDenoiser, IsThatOfTheFirstRank) {
  std::array<ChosenDenoiser, 2> chosen;
  const auto choose = [&chosen](DenoiserKind kind, const char* of_first, const char* of_second) {
    tests::run_ranks(2, [&](Ranks& ranks) {
      RenderOptions options;
      options.denoise = {.denoiser = kind, .library = ranks.first() ? of_first : of_second};
      options.ranks = &ranks;
      chosen[static_cast<std::size_t>(ranks.rank())] = choose_denoiser(options);
    });
  };
  for (const DenoiserKind kind : {DenoiserKind::automatic, DenoiserKind::oidn}) {
    choose(kind, GATELIGHT_STAND_IN_OIDN_2, "/none");
    EXPECT_TRUE(chosen[0].found && chosen[0].library);
    EXPECT_TRUE(chosen[1].found && !chosen[1].library);
  }
  choose(DenoiserKind::automatic, "/none", GATELIGHT_STAND_IN_OIDN_2);
  EXPECT_FALSE(chosen[0].found || chosen[1].found);
}

TEST(OptionsOfFilm, AreThoseOfALargerPictureWithNoMoreSamples) {
  RenderOptions options{.width = 30, .height = 20, .region = std::array<int, 4>{1, 2, 3, 4}, .spp = 48};
  EXPECT_EQ(options_of_film(options).width, 30);
  options.denoise.supersampling = 2;
  const RenderOptions film = options_of_film(options);
  EXPECT_EQ(film.width, 60);
  EXPECT_EQ(film.height, 40);
  EXPECT_EQ(*film.region, (std::array<int, 4>{2, 4, 6, 8}));
  EXPECT_EQ(film.spp, 12);
  EXPECT_EQ(film.filter, PixelFilter::box);
  for (const auto& [of_picture, of_film] :
       {std::pair(1, 1), {4, 1}, {5, 1}, {8, 2}, {kUnlimitedSpp, kUnlimitedSpp}}) {
    options.spp = of_picture;
    EXPECT_EQ(options_of_film(options).spp, of_film) << of_picture;
  }
}

}  // namespace
}  // namespace gatelight::renderer
