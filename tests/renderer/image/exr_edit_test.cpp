// EXRs of which some channels change, and all else stays.

#include <Imath/half.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineInputPart.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputPart.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "renderer/image/image_read.h"
#include "renderer/image/image_write.h"
#include "tests/support/temporary_folder.h"

namespace gatelight::renderer {
namespace {

using tests::TemporaryFolder;

/// The overscan of a picture whose own window is not at the origin.
const Imath::Box2i kDisplay({10, 20}, {14, 22});
const Imath::Box2i kData({8, -3}, {16, 24});
constexpr std::size_t kStoredWidth = 9, kStoredHeight = 28;

using Planes = std::map<std::string, std::vector<std::uint32_t>>;

Imf::Header header_of(const std::string& name, const std::map<std::string, Imf::PixelType>& channels) {
  Imf::Header header(kDisplay, kData);
  for (const auto& [channel, type] : channels) header.channels().insert(channel, Imf::Channel(type));
  header.setName(name);
  header.setType(Imf::SCANLINEIMAGE);
  header.insert("owner", Imf::StringAttribute("someone"));
  header.insert("shot", Imf::IntAttribute(7));
  return header;
}

template <class Slices>
Imf::FrameBuffer frame_of(const Imf::Header& header, Slices& planes) {
  Imf::FrameBuffer frame;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    std::vector<std::uint32_t>& plane = planes[it.name()];
    plane.resize(kStoredWidth * kStoredHeight);
    frame.insert(it.name(), Imf::Slice::Make(it.channel().type, plane.data(), kData, 4, 4 * kStoredWidth));
  }
  return frame;
}

/// Bits of all kinds, as each type has them, NaNs and numbers beyond a float's 24 bits among them.
Planes made_planes(const Imf::Header& header) {
  Planes planes;
  frame_of(header, planes);
  std::uint32_t bits = 1;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    for (std::uint32_t& value : planes[it.name()]) {
      bits = bits * 1664525u + 1013904223u;
      value = it.channel().type == Imf::HALF ? bits >> 16 : bits;
    }
  }
  return planes;
}

const std::map<std::string, Imf::PixelType> kChannels = {
    {"image.r", Imf::HALF}, {"image.g", Imf::HALF},  {"image.b", Imf::FLOAT}, {"image.id", Imf::UINT},
    {"mask.R", Imf::HALF},  {"depth.Z", Imf::FLOAT}, {"object", Imf::UINT}};

/// Writes parts of rows, or one of tiles.
std::string write_file(const TemporaryFolder& folder, const std::vector<Imf::Header>& headers,
                       std::vector<Planes>& planes) {
  const std::string path = (folder / "in.exr").string();
  Imf::MultiPartOutputFile file(path.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t p = 0; p < headers.size(); ++p) {
    planes.push_back(made_planes(headers[p]));
    const Imf::FrameBuffer frame = frame_of(headers[p], planes.back());
    if (headers[p].hasTileDescription()) {
      Imf::TiledOutputPart part(file, static_cast<int>(p));
      part.setFrameBuffer(frame);
      part.writeTiles(0, part.numXTiles() - 1, 0, part.numYTiles() - 1);
    } else {
      Imf::OutputPart part(file, static_cast<int>(p));
      part.setFrameBuffer(frame);
      part.writePixels(static_cast<int>(kStoredHeight));
    }
  }
  return path;
}

Planes read_part(const Imf::MultiPartInputFile& file, int part) {
  Planes planes;
  Imf::InputPart input(const_cast<Imf::MultiPartInputFile&>(file), part);
  input.setFrameBuffer(frame_of(file.header(part), planes));
  input.readPixels(kData.min.y, kData.max.y);
  return planes;
}

/// The picture with colours of 1 to 3 in "image".
Picture with_new_colors(const std::string& path) {
  Picture picture = read_image(path);
  Layer& image = *std::find_if(picture.layers.begin(), picture.layers.end(),
                               [](const Layer& layer) { return layer.name == "image"; });
  EXPECT_EQ(image.channels, (std::vector<std::string>{"R", "G", "B", "id"}));
  for (std::size_t i = 0; i < image.values.size(); ++i)
    image.values[i] = static_cast<float>(i % image.channels.size() + 1);
  return picture;
}

/// Writes it again with these colours, and checks the first part.
void expect_edited(const TemporaryFolder& folder, const std::string& path, const Imf::Header& before,
                   const Planes& planes) {
  const Picture picture = with_new_colors(path);
  const std::string out = (folder / "out.exr").string();
  write_image(picture, out, {.edited = EditedExr{path, {{"image", {"R", "G", "B"}}}}});
  const Imf::MultiPartInputFile file(out.c_str());
  const Imf::Header& header = file.header(0);
  EXPECT_EQ(header.displayWindow(), kDisplay);
  EXPECT_EQ(header.dataWindow(), kData);
  EXPECT_EQ(header.typedAttribute<Imf::StringAttribute>("owner").value(), "someone");
  EXPECT_EQ(header.typedAttribute<Imf::IntAttribute>("shot").value(), 7);
  EXPECT_EQ(header.channels(), before.channels()) << "names and types";
  const Planes now = read_part(file, 0);
  const half one(1.0f), two(2.0f);
  const float three = 3.0f;
  std::uint32_t bits = 0;
  std::memcpy(&bits, &three, sizeof bits);
  for (const auto& [name, plane] : planes) {
    std::vector<std::uint32_t> expected = plane;
    if (name == "image.r") expected.assign(kStoredWidth * kStoredHeight, one.bits());
    if (name == "image.g") expected.assign(kStoredWidth * kStoredHeight, two.bits());
    if (name == "image.b") expected.assign(kStoredWidth * kStoredHeight, bits);
    EXPECT_EQ(now.at(name), expected) << name;
  }
}

TEST(EditedExr, KeepsTheBitsOfAllElse) {
  for (const Imf::Compression compression :
       {Imf::NO_COMPRESSION, Imf::PIZ_COMPRESSION, Imf::ZIPS_COMPRESSION}) {
    const TemporaryFolder folder;
    Imf::Header header = header_of("", kChannels);
    header.compression() = compression;
    header.lineOrder() = compression == Imf::PIZ_COMPRESSION ? Imf::DECREASING_Y : Imf::INCREASING_Y;
    std::vector<Planes> planes;
    const std::string path = write_file(folder, {header}, planes);
    expect_edited(folder, path, header, planes[0]);
    const Imf::MultiPartInputFile file((folder / "out.exr").c_str());
    EXPECT_EQ(file.header(0).compression(), compression);
    EXPECT_EQ(file.header(0).lineOrder(), header.lineOrder());
  }
}

TEST(EditedExr, OfTilesHasRowsWithTheSameBits) {
  const TemporaryFolder folder;
  Imf::Header header = header_of("", kChannels);
  header.setType(Imf::TILEDIMAGE);
  header.setTileDescription(Imf::TileDescription(4, 5));
  header.lineOrder() = Imf::RANDOM_Y;
  std::vector<Planes> planes;
  const std::string path = write_file(folder, {header}, planes);
  expect_edited(folder, path, header, planes[0]);
}

/// What a lossy compression has made of the pixels comes back, and is not compressed like that again.
TEST(EditedExr, LosesNothingMoreToACompression) {
  const TemporaryFolder folder;
  Imf::Header header = header_of("", kChannels);
  header.compression() = Imf::B44_COMPRESSION;
  std::vector<Planes> planes;
  const std::string path = write_file(folder, {header}, planes);
  const Planes decoded = read_part(Imf::MultiPartInputFile(path.c_str()), 0);
  EXPECT_NE(decoded.at("mask.R"), planes[0].at("mask.R"));
  expect_edited(folder, path, header, decoded);
}

TEST(EditedExr, KeepsOtherParts) {
  const TemporaryFolder folder;
  Imf::Header tiles = header_of("tiles", {{"R", Imf::HALF}, {"G", Imf::HALF}, {"B", Imf::HALF}});
  tiles.setType(Imf::TILEDIMAGE);
  tiles.setTileDescription(Imf::TileDescription(4, 5));
  Imf::Header lossy = header_of("lossy", {{"Z", Imf::FLOAT}});
  lossy.compression() = Imf::B44_COMPRESSION;
  std::vector<Planes> planes;
  const std::string path = write_file(folder, {header_of("main", kChannels), tiles, lossy}, planes);
  expect_edited(folder, path, header_of("main", kChannels), planes[0]);
  const Imf::MultiPartInputFile before(path.c_str()), after((folder / "out.exr").c_str());
  ASSERT_EQ(after.parts(), 3);
  EXPECT_EQ(after.header(1).name(), "tiles");
  EXPECT_EQ(after.header(1).type(), Imf::TILEDIMAGE);
  EXPECT_EQ(after.header(2).compression(), Imf::B44_COMPRESSION);
  for (const int part : {1, 2}) EXPECT_EQ(read_part(after, part), read_part(before, part)) << part;
}

TEST(EditedExr, KeepsDeepParts) {
  const TemporaryFolder folder;
  const std::string path = (folder / "in.exr").string();
  Imf::Header deep = header_of("deep", {{"Z", Imf::FLOAT}});
  deep.setType(Imf::DEEPSCANLINE);
  deep.compression() = Imf::ZIPS_COMPRESSION;
  const Imf::Header main = header_of("main", kChannels);
  Planes planes = made_planes(main);
  const auto deep_frame = [](std::vector<unsigned>& counts, std::vector<float*>& samples) {
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts.data(), kData, 4, 4 * kStoredWidth));
    const Imf::Slice slice =
        Imf::Slice::Make(Imf::FLOAT, samples.data(), kData, sizeof(float*), sizeof(float*) * kStoredWidth);
    frame.insert("Z", Imf::DeepSlice(Imf::FLOAT, slice.base, sizeof(float*), sizeof(float*) * kStoredWidth,
                                     sizeof(float)));
    return frame;
  };
  std::vector<unsigned> counts(kStoredWidth * kStoredHeight, 2);
  std::vector<float> values = {1.5f, 2.5f};
  std::vector<float*> samples(kStoredWidth * kStoredHeight, values.data());
  {
    const Imf::Header headers[] = {main, deep};
    Imf::MultiPartOutputFile file(path.c_str(), headers, 2);
    Imf::OutputPart part(file, 0);
    part.setFrameBuffer(frame_of(main, planes));
    part.writePixels(static_cast<int>(kStoredHeight));
    Imf::DeepScanLineOutputPart of_deep(file, 1);
    of_deep.setFrameBuffer(deep_frame(counts, samples));
    of_deep.writePixels(static_cast<int>(kStoredHeight));
  }
  expect_edited(folder, path, main, planes);
  Imf::MultiPartInputFile file((folder / "out.exr").c_str());
  ASSERT_EQ(file.parts(), 2);
  Imf::DeepScanLineInputPart part(file, 1);
  std::vector<unsigned> read_counts(kStoredWidth * kStoredHeight);
  std::vector<float> read(2 * kStoredWidth * kStoredHeight);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = &read[2 * i];
  part.setFrameBuffer(deep_frame(read_counts, samples));
  part.readPixelSampleCounts(kData.min.y, kData.max.y);
  EXPECT_EQ(read_counts, counts);
  part.readPixels(kData.min.y, kData.max.y);
  EXPECT_EQ(read[100], 1.5f);
  EXPECT_EQ(read[101], 2.5f);
}

TEST(EditedExr, LeavesOutLayersAndTakesNewChannels) {
  const TemporaryFolder folder;
  std::vector<Planes> planes;
  const std::string path = write_file(folder, {header_of("", kChannels)}, planes);
  Picture picture = with_new_colors(path);
  std::erase_if(picture.layers,
                [](const Layer& layer) { return layer.name == "mask" || layer.name.empty(); });
  for (Layer& layer : picture.layers) {
    if (layer.name != "image") continue;
    layer.channels = {"R", "G", "A"};
    layer.values.assign(3 * kStoredWidth * kStoredHeight, 0.5f);
  }
  picture.metadata["denoiser"] = "a name";
  const std::string out = (folder / "out.exr").string();
  write_image(picture, out, {.exr_float = true, .edited = EditedExr{path, {{"image", {"R", "G", "A"}}}}});
  const Imf::MultiPartInputFile file(out.c_str());
  std::map<std::string, Imf::PixelType> channels;
  for (auto it = file.header(0).channels().begin(); it != file.header(0).channels().end(); ++it)
    channels[it.name()] = it.channel().type;
  EXPECT_EQ(channels, (std::map<std::string, Imf::PixelType>{{"image.r", Imf::FLOAT},
                                                             {"image.g", Imf::FLOAT},
                                                             {"image.A", Imf::FLOAT},
                                                             {"depth.Z", Imf::FLOAT}}));
  EXPECT_EQ(read_part(file, 0).at("depth.Z"), planes[0].at("depth.Z"));
  EXPECT_EQ(read_image(out).metadata.at("denoiser"), "a name");
}

TEST(EditedExr, ThatHasAnotherSizeNowIsRefused) {
  const TemporaryFolder folder;
  std::vector<Planes> planes;
  const std::string path = write_file(folder, {header_of("", kChannels)}, planes);
  const Picture picture{.width = 1, .height = 1, .layers = {{.channels = {"object"}, .values = {1.0f}}}};
  EXPECT_THROW(write_image(picture, folder / "out.exr", {.edited = EditedExr{path, {{"", {"object"}}}}}),
               OutputError);
}

}  // namespace
}  // namespace gatelight::renderer
