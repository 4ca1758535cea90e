#include "renderer/light/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "renderer/image/image_write.h"
#include "renderer/light/environment_picture.h"
#include "renderer/light/lights.h"
#include "renderer/sampling/warp.h"
#include "tests/support/light_scenes.h"
#include "tests/support/messages.h"
#include "tests/support/statistics.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using tests::expect_refusal;

constexpr std::size_t kTests = 8;

/// A dim gradient with a sun of one texel.
std::vector<Color> peaky(int width, int height) {
  std::vector<Color> texels;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      texels.emplace_back(Color::Constant(0.1f + 0.02f * static_cast<float>(x % 5) +
                                          0.5f * static_cast<float>(y) / static_cast<float>(height)));
    }
  }
  texels[static_cast<std::size_t>((height / 4) * width + width / 3)] = Color(5e4f, 4e4f, 3e4f);
  return texels;
}

std::vector<Color> random_texels(int count, std::uint64_t seed) {
  testing::Random random(seed);
  std::vector<Color> texels;
  for (int i = 0; i < count; ++i) {
    texels.emplace_back(Color::Constant(static_cast<float>(std::exp(random.uniform(-4.0, 4.0)))));
  }
  return texels;
}

/// Tests by chi-square in cells of equal steps in the picture's plane, each finely integrated, and by the
/// integral.
void expect_samples_follow_density(const EnvironmentPicture& picture, std::uint64_t seed) {
  constexpr int kColumns = 24;
  constexpr int kRows = 12;
  constexpr int kFine = 40;
  constexpr int kSamples = 100000;
  const auto direction = [](double u, double v) {
    const double phi = 2.0 * M_PI * (u - 0.5);
    const double sine = std::sin(M_PI * v);
    return Vec3(static_cast<float>(sine * std::sin(phi)), static_cast<float>(std::cos(M_PI * v)),
                static_cast<float>(-sine * std::cos(phi)));
  };
  std::vector<double> expected;
  double mass = 0.0;
  double radiance = 0.0;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      double sum = 0.0;
      for (int i = 0; i < kFine * kFine; ++i) {
        const double u = (column + (i % kFine + 0.5) / kFine) / kColumns;
        const double low = (row + static_cast<double>(i / kFine) / kFine) / kRows;
        const double high = (row + static_cast<double>(i / kFine + 1) / kFine) / kRows;
        const Vec3 wi = direction(u, 0.5 * (low + high));
        const double solid_angle =
            (std::cos(M_PI * low) - std::cos(M_PI * high)) * 2.0 * M_PI / (kColumns * kFine);
        sum += static_cast<double>(picture.pdf(wi)) * solid_angle;
        radiance += static_cast<double>(picture.radiance(wi).x()) * solid_angle;
      }
      expected.push_back(sum * kSamples);
      mass += sum;
    }
  }
  EXPECT_NEAR(mass, 1.0, 1e-4);
  std::vector<double> observed(expected.size(), 0.0);
  testing::Random random(seed);
  testing::Moments mean;
  for (int i = 0; i < kSamples; ++i) {
    const EnvironmentSample sample = picture.sample(testing::next_2d(random));
    ASSERT_GT(sample.pdf, 0.0f);
    ASSERT_NEAR(sample.wi.norm(), 1.0f, 1e-5f);
    mean.add(static_cast<double>(sample.radiance.x() / sample.pdf));
    const double column = (std::atan2(sample.wi.x(), -sample.wi.z()) / (2.0 * M_PI) + 0.5) * kColumns;
    const double row = std::acos(std::clamp(static_cast<double>(sample.wi.y()), -1.0, 1.0)) / M_PI * kRows;
    observed[static_cast<std::size_t>(std::clamp(static_cast<int>(row), 0, kRows - 1) * kColumns +
                                      std::clamp(static_cast<int>(column), 0, kColumns - 1))] += 1.0;
  }
  EXPECT_TRUE(testing::accepts(testing::chi_square_test(observed, expected),
                               testing::sidak(testing::kFamilySignificance, kTests)));
  // The sampled radiance and the density belong together: their quotient integrates the picture.
  EXPECT_GE(testing::mean_p_value(mean, radiance, 2e-3), testing::sidak(testing::kFamilySignificance, kTests))
      << mean.mean() << " +- " << mean.standard_error() << ", expected " << radiance;
}

TEST(EnvironmentTest, SamplesOfAPeakyPictureFollowTheDensity) {
  expect_samples_follow_density(EnvironmentPicture(240, 120, peaky(240, 120)), 1);
}

TEST(EnvironmentTest, SamplesOfAnyPictureFollowTheDensity) {
  expect_samples_follow_density(EnvironmentPicture(48, 24, random_texels(48 * 24, 2)), 2);
  expect_samples_follow_density(EnvironmentPicture(1, 1, {Color(1, 1, 1)}), 3);
  expect_samples_follow_density(EnvironmentPicture(1, 4, random_texels(4, 4)), 4);
  expect_samples_follow_density(EnvironmentPicture(6, 1, random_texels(6, 5)), 5);
}

TEST(EnvironmentTest, TheDensityIsNowhereZeroWhereThePictureShines) {
  const EnvironmentPicture picture(240, 120, peaky(240, 120));
  testing::Random random(6);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 wi = sample_uniform_sphere(testing::next_2d(random));
    ASSERT_GT(picture.pdf(wi), 0.0f);
  }
  for (const Vec3& pole : {Vec3(0, 1, 0), Vec3(0, -1, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    EXPECT_GT(picture.pdf(pole), 0.0f);
    EXPECT_TRUE(picture.radiance(pole).isFinite().all());
  }
}

TEST(EnvironmentTest, AFilteredLookupTendsToTheMean) {
  const EnvironmentPicture picture(96, 48, random_texels(96 * 48, 7));
  const Vec3 wi = Vec3(0.3f, 0.5f, -0.8f).normalized();
  EXPECT_EQ(picture.radiance(wi, 0.0f).x(), picture.radiance(wi).x());
  EXPECT_EQ(picture.radiance(wi, 1e-4f).x(), picture.radiance(wi).x());
  EXPECT_NEAR(picture.radiance(wi, 100.0f).x() / picture.mean().x(), 1.0f, 0.02f);
  // Odd sizes too: the mean of a constant is that constant on all levels.
  const EnvironmentPicture flat(37, 19, std::vector<Color>(37 * 19, Color(2, 2, 2)));
  for (const float cone : {0.0f, 0.1f, 0.5f, 1.0f, 3.0f, 6.0f}) {
    EXPECT_NEAR(flat.radiance(wi, cone).x(), 2.0f, 1e-5f);
  }
}

class EnvironmentFileTest : public ::testing::Test {
 protected:
  std::string write(int width, int height, const std::vector<Color>& texels) {
    Picture picture{.width = width, .height = height};
    Layer beauty{.channels = {"R", "G", "B"}, .full_precision = true};
    for (const Color& c : texels) beauty.values.insert(beauty.values.end(), {c.x(), c.y(), c.z()});
    picture.layers.push_back(beauty);
    const std::string path = (folder_.path() / "sky.exr").string();
    write_image(picture, path);
    return path;
  }
  tests::TemporaryFolder folder_;
};

TEST_F(EnvironmentFileTest, OrientationRotationAndScaleAreAsDocumented) {
  // Four columns, seen at +z (left half), -x, -z, +x in the order of u.
  std::vector<Color> texels;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) texels.emplace_back(Color::Constant(static_cast<float>(y < 2 ? x + 1 : 10)));
  }
  const std::string path = write(4, 4, texels);
  const auto at = [](const Environment& e, float u) {
    const float phi = 2.0f * kPi * (u - 0.5f);
    return e.radiance(Vec3(std::sin(phi), 1.0f, -std::cos(phi)).normalized()).x();
  };
  const Environment plain({.file = path});
  EXPECT_NEAR(at(plain, 0.375f), 2.0f, 1e-4f);  // between -x and -z
  EXPECT_NEAR(at(plain, 0.625f), 3.0f, 1e-4f);  // between -z and +x
  EXPECT_GT(plain.radiance(Vec3(0, -1, 0)).x(), 9.0f);
  EXPECT_FALSE(plain.constant());
  // A quarter turn counter-clockwise from above carries what was at -z to -x.
  const Environment turned({.file = path, .rotation_degrees = 90.0f, .scale = 2.0f});
  for (const float u : {0.1f, 0.3f, 0.6f, 0.9f}) {
    EXPECT_NEAR(at(turned, u - 0.25f + (u < 0.25f ? 1.0f : 0.0f)), 2.0f * at(plain, u), 1e-3f);
  }
  EXPECT_NEAR(plain.radiance(Vec3(0, 0.5f, -1).normalized()).x() * 2.0f,
              turned.radiance(Vec3(-1, 0.5f, 0).normalized()).x(), 1e-4f);
  EXPECT_NEAR(turned.mean().x(), 2.0f * plain.mean().x(), 1e-4f);
  testing::Random random(8);
  for (int i = 0; i < 1000; ++i) {
    const EnvironmentSample sample = turned.sample(testing::next_2d(random));
    EXPECT_NEAR(turned.radiance(sample.wi).x() / sample.radiance.x(), 1.0f, 1e-3f);
  }
}

TEST_F(EnvironmentFileTest, BadTexelsCountAsZero) {
  std::vector<Color> texels(8 * 4, Color(1, 1, 1));
  texels[3] = Color(std::numeric_limits<float>::quiet_NaN(), 1, 1);
  texels[9] = Color(kInfinity, -1, 1);
  texels[20] = Color(1e38f, 1e-38f, 0);
  const Environment environment({.file = write(8, 4, texels), .scale = 100.0f});
  testing::Random random(9);
  for (int i = 0; i < 5000; ++i) {
    const EnvironmentSample sample = environment.sample(testing::next_2d(random));
    ASSERT_TRUE(std::isfinite(sample.pdf) && sample.pdf > 0.0f);
    ASSERT_TRUE(sample.radiance.isFinite().all() && (sample.radiance >= 0.0f).all());
  }
  EXPECT_TRUE(environment.mean().isFinite().all());
}

TEST_F(EnvironmentFileTest, InfiniteTexelsStayTheBrightestAndAreReported) {
  std::vector<Color> texels(8 * 4, Color(1, 1, 1));
  texels[9] = Color(kInfinity, 2, 1);
  const Environment half({.file = write(8, 4, texels), .scale = 2.0f});
  texels[9].x() = 65504.0f;
  const Environment finite({.file = write(8, 4, texels), .scale = 2.0f});
  EXPECT_TRUE((half.mean() == finite.mean()).all());
  EXPECT_GT(half.mean().x(), 100.0f * half.mean().y());
  EXPECT_NE(half.warning().find("1 values are infinite and taken as 65504"), std::string::npos)
      << half.warning();
  EXPECT_EQ(finite.warning(), "");
  texels[9].x() = kInfinity;
  texels[10] = Color(-1, 1e6f, std::numeric_limits<float>::quiet_NaN());
  const std::string warning = Environment({.file = write(8, 4, texels)}).warning();
  EXPECT_NE(warning.find("taken as 1000000, 2 negative or NaN"), std::string::npos) << warning;
}

TEST_F(EnvironmentFileTest, ColoursAreChosenByTheNamesOfTheirChannels) {
  const std::string path = (folder_.path() / "sky.exr").string();
  const auto light = [&](const std::vector<std::string>& channels) {
    Picture picture{.width = 4, .height = 2};
    Layer layer{.channels = channels, .full_precision = true};
    for (int i = 0; i < 8; ++i) {
      for (std::size_t c = 0; c < channels.size(); ++c) layer.values.push_back(static_cast<float>(c + 1));
    }
    picture.layers = {layer};
    write_image(picture, path);
    return Environment({.file = path}).radiance(Vec3(0, 1, 0));
  };
  EXPECT_TRUE(light({"A", "B", "G", "R", "Z"}).isApprox(Color(4, 3, 2)));
  EXPECT_TRUE(light({"b", "g", "r"}).isApprox(Color(3, 2, 1))) << "in any case";
  EXPECT_TRUE(light({"A", "Y"}).isApprox(Color(2, 2, 2))) << "alpha is no light";
  const std::vector<std::vector<std::string>> without = {
      {"Z"}, {"A"}, {"R", "G"}, {"X", "Y", "Z"}, {"G", "Y"}};
  for (const std::vector<std::string>& channels : without) {
    expect_refusal<InputError>([&] { light(channels); }, {"sky.exr", channels[0], "R", "G", "B", "Y"});
  }
}

TEST_F(EnvironmentFileTest, PartsOfTheDisplayWindowThatAreNotStoredAreBlack) {
  const std::string path = (folder_.path() / "sky.exr").string();
  Picture picture{.width = 8, .height = 6, .x0 = -2, .y0 = -1, .full_width = 16, .full_height = 8};
  picture.layers = {{.channels = {"R", "G", "B"}, .values = std::vector<float>(8 * 6 * 3, 1.0f)}};
  write_image(picture, path);
  const Environment environment({.file = path});
  const auto at = [&](float u, float v) {
    const float phi = 2.0f * kPi * (u - 0.5f), theta = kPi * v;
    return environment
        .radiance(Vec3(std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)))
        .x();
  };
  // Columns 0 to 5 of 16 and rows 0 to 4 of 8 are stored; two columns and a row lie outside.
  EXPECT_NEAR(at(0.2f, 0.3f), 1.0f, 1e-5f);
  EXPECT_NEAR(at(0.33f, 0.5f), 1.0f, 0.5f);
  EXPECT_EQ(at(0.5f, 0.3f), 0.0f);
  EXPECT_EQ(at(0.2f, 0.8f), 0.0f);
  picture.full_width = 1 << 16;
  picture.full_height = 1 << 14;
  write_image(picture, path);
  EXPECT_THROW(Environment({.file = path}), InputError) << "a header that claims a billion pixels";
}

TEST_F(EnvironmentFileTest, ABlackPictureIsNoLight) {
  const Environment environment({.file = write(8, 4, std::vector<Color>(32, Color(0, 0, 0)))});
  EXPECT_TRUE(environment.black());
  EXPECT_EQ(environment.sample(Vec2(0.5f, 0.5f)).pdf, 0.0f);
  EXPECT_EQ(environment.pdf(Vec3(0, 1, 0)), 0.0f);
  const scene::Scene scene;
  const Textures textures(scene);
  EXPECT_TRUE(Lights(scene, textures, environment, LightSelection::tree).empty());
}

TEST(EnvironmentTest, AConstantIsTheSameEverywhere) {
  const Environment environment({.constant = Color(1, 2, 3), .scale = 2.0f});
  EXPECT_TRUE(environment.constant());
  EXPECT_TRUE((environment.radiance(Vec3(0, 0, 1)) == Color(2, 4, 6)).all());
  EXPECT_TRUE((environment.radiance(Vec3(0, 0, 1), 0.5f) == Color(2, 4, 6)).all());
  EXPECT_NEAR(environment.pdf(Vec3(1, 0, 0)), 0.25 / M_PI, 1e-6);
  EXPECT_TRUE(Environment({}).black());
  const Environment bright({.constant = Color(3e38f, 1, 0), .scale = 3e38f});
  EXPECT_TRUE((bright.mean() == Color(1e30f, 1e30f, 0)).all()) << "the greatest, not none";
}

TEST(EnvironmentTest, AFileThatCannotBeReadIsNamed) {
  expect_refusal<InputError>([] { Environment({.file = "no/such/sky.exr"}); }, {"no/such/sky.exr"});
  EXPECT_THROW(Environment({.constant = Color(1, 1, 1), .scale = -1.0f}), InputError);
  EXPECT_THROW(Environment({.constant = Color(1, 1, 1), .rotation_degrees = kInfinity}), InputError);
}

}  // namespace
}  // namespace gatelight::renderer
