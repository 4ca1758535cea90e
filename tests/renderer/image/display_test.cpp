// Pictures as they are shown: formats, bits, alpha, white balance, OpenColorIO, the curves to the screen, and
// the automatic exposure.

#include "renderer/image/display.h"

#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenImageIO/imagebuf.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/errors.h"
#include "renderer/image/auto_exposure.h"
#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "renderer/image/tonemap.h"
#include "renderer/image/white_balance.h"
#include "tests/support/messages.h"
#include "tests/support/rgb_pictures.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using ::testing::ElementsAre;
using tests::expect_refused_parts;
using tests::read_file;
using tests::TemporaryFolder;

Picture gradient(bool with_alpha) {
  Picture picture{.width = 40, .height = 25};
  Layer beauty{.channels = {"R", "G", "B"}};
  if (with_alpha) beauty.channels.emplace_back("A");
  for (int i = 0; i < 1000; ++i) {
    const float x = static_cast<float>(i) / 999.0f, alpha = with_alpha ? 0.25f + 0.75f * x : 1.0f;
    beauty.values.insert(beauty.values.end(), {alpha * x, alpha * 0.5f * x, alpha * 0.2f});
    if (with_alpha) beauty.values.push_back(alpha);
  }
  picture.layers.push_back(beauty);
  return picture;
}

OIIO::ImageBuf read_raw(const std::filesystem::path& file) {
  OIIO::ImageBuf image(file.string());
  EXPECT_TRUE(image.read(0, 0, true, OIIO::TypeDesc::FLOAT)) << image.geterror();
  return image;
}

TEST(Display, EveryFormatHasTheSameCodeValues) {
  const TemporaryFolder folder;
  const DisplayOptions display{.exposure = -0.5f, .white_balance = 5000.0f, .tonemap = Tonemap::neutral};
  for (const bool with_alpha : {false, true}) {
    const Picture picture = gradient(with_alpha);
    const std::vector<float> values = displayed(picture, display);
    for (const int bits : {8, 16}) {
      for (const char* name : {"a.png", "a.tif", "a.jpg"}) {
        const bool jpeg = std::string(name) == "a.jpg";
        if (jpeg && (bits == 16 || with_alpha)) continue;
        write_image(picture, folder / name, {.bits = bits, .display = display});
        // Files with straight alpha are read as they are: unassociated.
        OIIO::ImageSpec keep;
        keep["oiio:UnassociatedAlpha"] = 1;
        OIIO::ImageBuf image((folder / name).string(), 0, 0, nullptr, &keep);
        ASSERT_TRUE(image.read(0, 0, true, OIIO::TypeDesc::FLOAT)) << image.geterror();
        ASSERT_EQ(image.nchannels(), with_alpha ? 4 : 3) << name;
        if (!jpeg) {
          EXPECT_EQ(image.nativespec().format, bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::UINT8);
        }
        const float unit = jpeg ? 6.0f / 255.0f : 0.51f / (bits == 16 ? 65535.0f : 255.0f);
        const std::size_t channels = with_alpha ? 4 : 3;
        for (int p = 0; p < 1000; ++p) {
          for (std::size_t c = 0; c < channels; ++c) {
            ASSERT_NEAR(image.getchannel(p % 40, p / 40, 0, static_cast<int>(c)),
                        values[static_cast<std::size_t>(p) * channels + c], unit)
                << name << " " << bits << " pixel " << p << " channel " << c;
          }
        }
      }
    }
  }
}

TEST(Display, HdrKeepsTheRadiance) {
  const TemporaryFolder folder;
  Picture picture = gradient(false);
  for (float& x : picture.layers[0].values) x *= 300.0f;
  write_image(picture, folder / "a.hdr", {.display = {.exposure = 3.0f}});
  const Picture read = read_image(folder / "a.hdr");
  for (std::size_t i = 0; i < read.layers[0].values.size(); ++i) {
    const std::size_t pixel = i - i % 3;
    // Eight bits of the brightest channel.
    const float most =
        *std::max_element(&picture.layers[0].values[pixel], &picture.layers[0].values[pixel] + 3);
    EXPECT_NEAR(read.layers[0].values[i], picture.layers[0].values[i], most / 100.0f);
  }
}

TEST(Display, EqualPicturesAreEqualFiles) {
  const TemporaryFolder folder;
  for (const char* extension : {"exr", "png", "jpg", "tif", "hdr"}) {
    const auto name = [&](const char* stem) { return folder / (std::string(stem) + "." + extension); };
    write_image(gradient(false), name("a"), {.bits = 16});
    write_image(gradient(false), name("b"), {.bits = 16});
    EXPECT_FALSE(read_file(name("a")).empty());
    EXPECT_EQ(read_file(name("a")), read_file(name("b"))) << extension;
  }
}

TEST(Display, AnExrHasPremultipliedAlphaItsGamutAndItsView) {
  const TemporaryFolder folder;
  Picture picture = gradient(true);
  picture.view.emplace();
  for (std::size_t i = 0; i < 16; ++i) {
    picture.view->world_to_camera[i] = static_cast<float>(i);
    picture.view->world_to_ndc[i] = static_cast<float>(100 + i);
  }
  write_image(picture, folder / "a.exr", {.exr_float = true});
  const Picture read = read_image(folder / "a.exr");
  const Layer& beauty = read.layers.front();
  ASSERT_EQ(beauty.channels.size(), 4u);
  const OIIO::ImageBuf image = read_raw(folder / "a.exr");
  EXPECT_NEAR(image.getchannel(39, 24, 0, 0), 1.0f, 1e-6f);
  EXPECT_NEAR(image.getchannel(0, 0, 0, 2), 0.25f * 0.2f, 1e-6f);
  EXPECT_NEAR(image.getchannel(0, 0, 0, 3), 0.25f, 1e-6f);
  Imf::InputFile file((folder / "a.exr").string().c_str());
  EXPECT_NEAR(Imf::chromaticities(file.header()).red.x, 0.64f, 1e-6f);
  // Column 3 of ours, by which points move, is the row of OpenEXR's.
  EXPECT_EQ(Imf::worldToCamera(file.header())[3][1], 13.0f);
  EXPECT_EQ(Imf::worldToNDC(file.header())[0][2], 102.0f);
}

TEST(WhiteBalance, MakesItsLightWhiteAndKeepsDaylight) {
  EXPECT_TRUE(white_balance(kDaylightKelvin).isIdentity());
  // Published chromaticities: CIE illuminant A (2856 K, on the black body), D50 and D75.
  struct Light {
    float kelvin;
    double x, y;
  };
  Eigen::Matrix3d to_xyz;
  to_xyz << 0.4123908, 0.3575843, 0.1804808, 0.2126390, 0.7151687, 0.0721923, 0.0193308, 0.1191948, 0.9505322;
  for (const Light& light :
       {Light{2856.0f, 0.44758, 0.40745}, {5003.0f, 0.34567, 0.35850}, {7504.0f, 0.29902, 0.31485}}) {
    const Eigen::Vector3d xyz(light.x / light.y, 1.0, (1.0 - light.x - light.y) / light.y);
    const Eigen::Vector3f rgb = (to_xyz.inverse() * xyz).cast<float>();
    const Eigen::Vector3f balanced = white_balance(light.kelvin) * rgb;
    EXPECT_TRUE(balanced.isApprox(Eigen::Vector3f::Ones(), 0.015f))
        << light.kelvin << ": " << balanced.transpose();
    EXPECT_FALSE(rgb.isApprox(Eigen::Vector3f::Ones(), 0.05f));
  }
  EXPECT_LT(white_balance(2000.0f)(0, 0), white_balance(6000.0f)(0, 0)) << "warm light loses red";
}

constexpr const char* kConfig = R"(ocio_profile_version: 1
roles:
  scene_linear: lin_rec709
displays:
  screen:
    - !<View> {name: square root, colorspace: root}
    - !<View> {name: as it is, colorspace: lin_rec709}
  wall:
    - !<View> {name: only, colorspace: root}
active_displays: [screen, wall]
colorspaces:
  - !<ColorSpace>
    name: lin_rec709
  - !<ColorSpace>
    name: root
    from_reference: !<ExponentTransform> {value: [0.5, 0.5, 0.5, 1]}
)";

TEST(Ocio, AViewReplacesTheCurve) {
  const TemporaryFolder folder;
  const std::string config = folder.write("config.ocio", kConfig).string();
  const Picture picture = gradient(false);
  DisplayOptions options{.exposure = -1.0f, .tonemap = Tonemap::filmic, .ocio = {config, "", ""}};
  check_display(options);
  const std::vector<float> root = displayed(picture, options);
  options.ocio = {config, "screen", "as it is"};
  const std::vector<float> plain = displayed(picture, options);
  for (std::size_t i = 0; i < root.size(); ++i) {
    const float half = 0.5f * picture.layers[0].values[i];
    EXPECT_NEAR(root[i], std::sqrt(half), 2e-3f);
    EXPECT_NEAR(plain[i], half, 1e-5f);
  }
}

TEST(Ocio, MissingNamesAreReportedWithTheAvailableOnes) {
  const TemporaryFolder folder;
  const std::string config = folder.write("config.ocio", kConfig).string();
  const auto refuse = [](const OcioView& view, const ErrorParts& wanted) {
    expect_refused_parts<BadOption>([&] { check_display({.ocio = view}); }, wanted);
  };
  refuse({config, "cinema", ""}, {"ocio-display", "cinema", "", "'wall'"});
  refuse({config, "screen", "film"}, {"ocio-view", "film", "", "square root"});
  refuse({(folder / "no.ocio").string(), "", ""}, {"ocio", (folder / "no.ocio").string()});
  const std::string broken = folder.write("broken.ocio", "displays: [").string();
  refuse({broken, "", ""}, {"ocio", broken});
}

constexpr Tonemap kCurves[] = {Tonemap::none, Tonemap::filmic, Tonemap::neutral, Tonemap::aces, Tonemap::agx};

TEST(Curves, GreysRiseStayGreyAndStayInTheScreensRange) {
  for (const Tonemap curve : kCurves) {
    float last = 0.0f;
    for (float x = 1e-6f; x < 1e30f; x *= 1.3f) {
      const Color shown = tonemapped(Color::Constant(x), curve);
      EXPECT_GE(shown.minCoeff(), last - 1e-4f) << x;
      EXPECT_LE(shown.maxCoeff(), 1.0f) << x;
      EXPECT_LT(shown.maxCoeff() - shown.minCoeff(), 2e-3f) << x;
      last = shown.minCoeff();
    }
    EXPECT_GT(last, 0.95f);
    EXPECT_LT(tonemapped(Color::Zero(), curve).maxCoeff(), 1e-3f);
  }
}

TEST(Curves, NonFiniteAndNegativeValuesStayInTheScreensRange) {
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              infinite = std::numeric_limits<float>::infinity();
  for (const Tonemap curve : kCurves) {
    for (const Color& color :
         {Color(nan, 1, 0), Color(-3, 0.5f, 2), Color(infinite, infinite, infinite), Color(infinite, 0, 1)}) {
      const Color shown = tonemapped(color, curve);
      EXPECT_TRUE(shown.allFinite());
      EXPECT_GE(shown.minCoeff(), 0.0f);
      EXPECT_LE(shown.maxCoeff(), 1.0f);
    }
  }
  EXPECT_EQ(filmic(infinite), 1.0f);
  EXPECT_EQ(filmic(nan), 0.0f);
}

TEST(Neutral, KeepsColoursBelowItsShoulderButForTheGlare) {
  // The specification: base colours up to 0.8 arrive as they are, after 0.04 of Fresnel reflection is taken
  // off.
  const Color color(0.5f, 0.3f, 0.7f);
  EXPECT_TRUE(tonemapped(color, Tonemap::neutral).isApprox(color - 0.04f, 1e-6f));
  EXPECT_NEAR(tonemapped(Color::Constant(0.04f), Tonemap::neutral).x(), 6.25f * 0.04f * 0.04f, 1e-6f);
  // A grey of 2, less 0.04, becomes 1 - 0.24^2 / (1.96 + 0.24 - 0.76).
  EXPECT_NEAR(tonemapped(Color::Constant(2.0f), Tonemap::neutral).x(), 0.96f, 1e-4f);
}

/// The position of the middle channel between the least and the greatest.
float hue(const Color& c) {
  return (c[1] - c[2]) / (c[0] - c[2]);
}

TEST(Neutral, KeepsHuesThatClampingShifts) {
  const Color orange(10.0f, 2.0f, 0.1f);
  EXPECT_NEAR(hue(tonemapped(orange, Tonemap::neutral)), hue(orange), 1e-3f);
  EXPECT_GT(hue(tonemapped(orange, Tonemap::none)), 0.9f) << "clamped it is yellow";
}

TEST(MiddleGrey, IsShownNearTheMiddle) {
  for (const Tonemap curve : {Tonemap::aces, Tonemap::agx, Tonemap::filmic}) {
    const float grey = tonemapped(Color::Constant(0.18f), curve).x();
    EXPECT_GT(grey, 0.09f);
    EXPECT_LT(grey, 0.28f);
  }
}

Picture of(const std::vector<float>& greys) {
  std::vector<float> values;
  for (const float grey : greys) values.insert(values.end(), 3, grey);
  return testing::rgb(static_cast<int>(greys.size()), 1, std::move(values));
}

TEST(AutoExposure, BringsTheLogAverageToMiddleGrey) {
  EXPECT_NEAR(auto_exposure(of({0.18f, 0.18f})), 0.0f, 1e-6f);
  EXPECT_NEAR(auto_exposure(of({0.045f, 0.045f})), 2.0f, 1e-6f);
  EXPECT_NEAR(auto_exposure(of({0.09f, 0.36f})), 0.0f, 1e-6f);
  EXPECT_NEAR(auto_exposure(of({0.045f, 0.0f, 0.0f})), 2.0f, 1e-6f) << "black pixels do not count";
}

TEST(AutoExposure, LimitsBrightPartsAndIsZeroWithoutLight) {
  // A tenth of the picture is a window of 100 times the rest.
  std::vector<float> room(100, 0.02f);
  std::fill_n(room.begin(), 10, 20.0f);
  EXPECT_NEAR(auto_exposure(of(room)), std::log2(12.0f / 20.0f), 0.051f);
  // A fifth is a floor in the sun.
  std::fill_n(room.begin(), 20, 0.6f);
  EXPECT_NEAR(auto_exposure(of(room)), std::log2(0.75f / 0.6f), 0.051f);
  // A lamp of one pixel does not count.
  room.assign(100, 0.02f);
  room[7] = 1e4f;
  EXPECT_GT(auto_exposure(of(room)), 2.5f);
  EXPECT_EQ(auto_exposure(of({0.0f, 0.0f})), 0.0f);
  EXPECT_EQ(auto_exposure(of({std::numeric_limits<float>::quiet_NaN(), -1.0f})), 0.0f);
}

}  // namespace
}  // namespace gatelight::renderer
