// EXR files of several parts, as Blender and others write them.

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/denoise/layers_to_denoise.h"
#include "renderer/image/image_read.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using tests::TemporaryFolder;

struct Part {
  std::string name;
  std::vector<std::string> channels;
  float value = 0.0f;  ///< of the first channel; each other has one more
  int width = 3;
};

/// Writes parts with a height of 2.
std::string write_parts(const TemporaryFolder& folder, const std::vector<Part>& parts) {
  std::vector<Imf::Header> headers;
  for (const Part& part : parts) {
    Imf::Header header(3, 2);
    header.dataWindow().max.x = part.width - 1;
    header.setName(part.name);
    header.setType(Imf::SCANLINEIMAGE);
    for (const std::string& channel : part.channels)
      header.channels().insert(channel, Imf::Channel(Imf::FLOAT));
    headers.push_back(header);
  }
  const std::string path = (folder / "parts.exr").string();
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t p = 0; p < parts.size(); ++p) {
    Imf::FrameBuffer frame;
    std::vector<std::vector<float>> values;
    const auto width = static_cast<std::size_t>(parts[p].width);
    for (std::size_t c = 0; c < parts[p].channels.size(); ++c)
      values.emplace_back(2 * width, parts[p].value + static_cast<float>(c));
    for (std::size_t c = 0; c < values.size(); ++c) {
      frame.insert(parts[p].channels[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values[c].data()),
                                                    sizeof(float), width * sizeof(float)));
    }
    Imf::OutputPart part(file, static_cast<int>(p));
    part.setFrameBuffer(frame);
    part.writePixels(2);
  }
  return path;
}

TEST(ExrParts, AreLayersWithTheNamesOfTheirChannelsOrTheirOwn) {
  const TemporaryFolder folder;
  const Picture picture = read_image(write_parts(
      folder,
      {{"View.Depth", {"View.Depth.Z"}, 1.0f},
       {"View.Combined", {"View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Combined.A"}, 2.0f},
       {"View.Denoising Albedo",
        {"View.Denoising Albedo.R", "View.Denoising Albedo.G", "View.Denoising Albedo.B"},
        10.0f},
       {"View.Denoising Normal", {"X", "Y", "Z"}, 20.0f}}));
  ASSERT_EQ(picture.layers.size(), 4u);
  EXPECT_EQ(picture.layers[0].name, "View.Combined") << "the layer that is shown comes first";
  EXPECT_EQ(picture.layers[0].values[2], 4.0f);
  ASSERT_TRUE(picture.find("View.Denoising Normal")) << "channels without a layer take the name of the part";
  EXPECT_EQ(picture.find("View.Depth")->values, std::vector<float>(6, 1.0f));
  // The guides of other renderers are found in parts too.
  const Samples samples = samples_of(picture, layers_to_denoise(picture).front());
  ASSERT_EQ(samples.albedo.size(), 18u);
  EXPECT_EQ(samples.color[0], 2.0f);
  EXPECT_EQ(samples.albedo[4], 11.0f);
  EXPECT_EQ(samples.normal[17], 22.0f);
}

TEST(ExrParts, OfAnotherSizeAndOfTheSameNameAreLeftOut) {
  const TemporaryFolder folder;
  const Picture picture = read_image(write_parts(folder, {{"left", {"R", "G", "B"}, 1.0f},
                                                          {"right", {"right.R", "right.G", "right.B"}, 5.0f},
                                                          {"again", {"right.R"}, 7.0f},
                                                          {"thumbnail", {"R", "G", "B"}, 9.0f, 2}}));
  ASSERT_EQ(picture.layers.size(), 2u);
  EXPECT_EQ(picture.layers[0].name, "left");
  EXPECT_EQ(picture.find("right")->values[0], 5.0f);
}

TEST(ExrParts, PutTheBeautyPartFirst) {
  const TemporaryFolder folder;
  const Picture picture = read_image(write_parts(
      folder,
      {{"albedo", {"R", "G", "B"}, 1.0f}, {"Beauty", {"R", "G", "B"}, 5.0f}, {"N", {"X", "Y", "Z"}, 9.0f}}));
  EXPECT_EQ(picture.layers[0].name, "Beauty");
  const Samples samples = samples_of(picture, layers_to_denoise(picture).front());
  EXPECT_EQ(samples.color[0], 5.0f);
  EXPECT_EQ(samples.albedo[0], 1.0f);
  EXPECT_EQ(samples.normal[0], 9.0f);
}

/// A crash left the second part behind without pixels.
TEST(ExrParts, ThatCannotBeReadAreLeftOut) {
  const TemporaryFolder folder;
  const std::string path =
      write_parts(folder, {{"rgba", {"R", "G", "B"}, 1.0f}, {"N", {"X", "Y", "Z"}, 9.0f}});
  ASSERT_EQ(read_image(path).layers.size(), 2u);
  std::filesystem::resize_file(path, std::filesystem::file_size(path) - 8);
  const Picture picture = read_image(path);
  ASSERT_EQ(picture.layers.size(), 1u);
  EXPECT_EQ(picture.layers[0].values[1], 2.0f);
}

}  // namespace
}  // namespace gatelight::renderer
