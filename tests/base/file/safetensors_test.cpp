#include "base/file/safetensors.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "base/errors.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/messages.h"
#include "tests/support/temporary_folder.h"

namespace gatelight {
namespace {

using gatelight::tests::expect_message;
using gatelight::tests::expect_refusal;
using gatelight::tests::FileSizeLimit;
using gatelight::tests::NameList;
using gatelight::tests::Place;
using gatelight::tests::read_file;
using gatelight::tests::refusal;
using gatelight::tests::TemporaryFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string file_bytes(std::uint64_t length, const std::string& header, const std::string& data = "") {
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &length, 8);
  return bytes + header + data;
}

/// Returns a file with this header and this number of bytes of data.
std::string file_bytes(const std::string& header, std::size_t data_bytes) {
  return file_bytes(header.size(), header, std::string(data_bytes, 'x'));
}

/// Expects that reading these bytes is refused with the file and the names, or succeeds if there are none.
void expect_reading(const TemporaryFolder& folder, const std::string& bytes, NameList names,
                    Place place = Place::current()) {
  const auto path = folder.write("cache.safetensors", bytes);
  const auto read = [&] { SafetensorsReader reader(path); };
  if (names.empty()) return read();
  names.push_back(path.string());
  expect_refusal<CacheFileError>(read, names, place);
}

TEST(Safetensors, TensorsAndMetadataComeBack) {
  const TemporaryFolder folder;
  const std::array<float, 6> floats = {1.0f, -0.0f, 1e-42f, 3e38f, 0.1f, -7.0f};
  const std::array<std::uint16_t, 3> halves = {0x3c00, 0x8000, 0x7bff};
  const std::array<std::uint64_t, 1> count = {0xfedcba9876543210u};
  const std::array<double, 2> sums = {0.1, -1e300};
  const std::vector<TensorView> tensors = {
      {"halves", TensorType::f16, {3}, std::as_bytes(std::span(halves))},
      {"floats \"quoted\"", TensorType::f32, {2, 3}, std::as_bytes(std::span(floats))},
      {"nothing", TensorType::u32, {0, 8}, {}},
      {"count", TensorType::u64, {}, std::as_bytes(std::span(count))},
      {"sums", TensorType::f64, {2}, std::as_bytes(std::span(sums))}};
  const Metadata metadata = {{"name", "caf\u00e9 {\"a\": 1}\n"}, {"empty", ""}};
  write_safetensors(folder / "a", tensors, metadata);

  SafetensorsReader reader(folder / "a");
  EXPECT_EQ(reader.metadata(), metadata);
  EXPECT_THAT(reader.names(), ElementsAre("count", "floats \"quoted\"", "halves", "nothing", "sums"));
  std::array<std::byte, 24> out;
  for (const TensorView& tensor : tensors) {
    reader.read(tensor.name, tensor.type, tensor.shape, std::span(out).first(tensor.data.size()));
    EXPECT_TRUE(std::equal(tensor.data.begin(), tensor.data.end(), out.begin())) << tensor.name;
  }
  const std::string file = (folder / "a").string();
  expect_refusal<CacheFileError>([&] { reader.read("halves", TensorType::f32, tensors[0].shape, out); },
                                 {file, "halves", "F16 [3]", "F32 [3]"});
  expect_refusal<CacheFileError>([&] { reader.read("halves", TensorType::f16, tensors[1].shape, out); },
                                 {file, "halves", "F16 [3]", "F16 [2, 3]"});
  expect_refusal<CacheFileError>([&] { reader.read("other", TensorType::f32, {}, out); }, {file, "other"});
  EXPECT_EQ(reader.length("sums", TensorType::f64), 2u);
  expect_refusal<CacheFileError>([&] { reader.length("sums", TensorType::u64); },
                                 {file, "sums", "F64 [2]", "U64 [any]"});
  expect_refusal<CacheFileError>([&] { reader.length("count", TensorType::u64); }, {file, "count", "U64 []"});
  expect_refusal<CacheFileError>([&] { reader.length("other", TensorType::u64); }, {file, "other"});
}

TEST(Safetensors, EachTensorIsAlignedToItsElements) {
  const TemporaryFolder folder;
  const std::array<std::byte, 24> zeros{};
  const std::span bytes(zeros);
  const std::vector<TensorView> tensors = {{"a", TensorType::f16, {3}, bytes.first(6)},
                                           {"b", TensorType::f32, {1}, bytes.first(4)},
                                           {"c", TensorType::u64, {3}, bytes.first(24)}};
  write_safetensors(folder / "a", tensors, {});
  const std::string file = read_file(folder / "a");
  std::uint64_t length = 0;
  std::memcpy(&length, file.data(), 8);
  EXPECT_EQ(length % 8, 0u);
  const std::string header = file.substr(8, length);
  EXPECT_THAT(header, AllOf(HasSubstr("\"c\":{\"dtype\":\"U64\",\"shape\":[3],\"data_offsets\":[0,24]}"),
                            HasSubstr("\"b\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[24,28]}"),
                            HasSubstr("\"a\":{\"dtype\":\"F16\",\"shape\":[3],\"data_offsets\":[28,34]}")));
  EXPECT_EQ(file.size(), 8 + length + 34);
}

TEST(Safetensors, BrokenLengthsAreRefused) {
  const TemporaryFolder folder;
  expect_reading(folder, "", {"0 bytes"});
  expect_reading(folder, "1234567", {"7 bytes"});
  expect_reading(folder, file_bytes(0, ""), {"header", "0 bytes"});
  expect_reading(folder, file_bytes(3, "{}"), {"header", "3 bytes", "2"});
  expect_reading(folder, file_bytes(~std::uint64_t{0}, "{}"), {"header", "18446744073709551615"});
  expect_reading(folder, file_bytes(std::uint64_t{1} << 63, "{}"), {"header", "9223372036854775808"});
  const std::string large(std::size_t{1} << 20, ' ');
  expect_reading(folder, file_bytes("{}" + large, 0), {"header", "1048578", "1048576"});
  expect_reading(folder, file_bytes("{}", 0), {});
}

TEST(Safetensors, BrokenHeadersAreRefused) {
  const TemporaryFolder folder;
  const auto entry = [](const std::string& dtype, const std::string& shape, const std::string& offsets) {
    return R"({"a":{"dtype":)" + dtype + R"(,"shape":)" + shape + R"(,"data_offsets":)" + offsets + "}}";
  };
  struct Case {
    std::string header;
    std::size_t data_bytes;
    NameList names;
  };
  const std::vector<Case> cases = {
      {entry("\"F32\"", "[2,1]", "[0,8]"), 8, {}},
      {"[]", 0, {"{"}},
      {" {}", 0, {"{"}},
      {"{\"a\":", 0, {"JSON"}},
      {"{} x", 0, {"JSON"}},
      {std::string("{}\0\0", 4), 0, {"NUL"}},
      {"{\"\xff\":1}", 0, {"JSON"}},
      {std::string(100000, '['), 0, {"{"}},
      {"{\"a\":" + std::string(100000, '['), 0, {"3"}},
      {"{\"a\":[[" + std::string(50000, '[') + std::string(50000, ']') + "]]}", 0, {"3"}},
      {entry("[[1]]", "[1]", "[0,8]"), 8, {"3"}},
      {entry("[1]", "[1]", "[0,8]"), 8, {"a", "dtype [1]", "F16"}},
      {R"({"a":1})", 0, {"a"}},
      {R"({"__metadata__":{"k":1}})", 0, {"metadata", "k"}},
      {R"({"__metadata__":"k"})", 0, {"__metadata__"}},
      {R"({"__metadata__":{"k":"1","k":"2"}})", 0, {"k"}},
      {R"({"a":{"dtype":"F32","shape":[1]}})", 4, {"a", "dtype", "shape", "data_offsets"}},
      {entry("\"I64\"", "[1]", "[0,8]"), 8, {"a", "dtype \"I64\"", "F16"}},
      {entry("7", "[1]", "[0,8]"), 8, {"a", "dtype 7"}},
      {entry("\"F32\"", "2", "[0,8]"), 8, {"a", "shape 2"}},
      {entry("\"F32\"", "[-2]", "[0,8]"), 8, {"a", "shape [-2]"}},
      {entry("\"F32\"", "[2.0]", "[0,8]"), 8, {"a", "shape [2.0]"}},
      {entry("\"F32\"", "[1e400]", "[0,8]"), 8, {"JSON"}},
      {entry("\"F32\"", "[18446744073709551616]", "[0,8]"), 8, {"a", "shape ["}},
      {entry("\"F32\"", "[2]", "[0]"), 8, {"a", "data_offsets [0]"}},
      {entry("\"F32\"", "[2]", "[0,4,8]"), 8, {"a", "data_offsets [0,4,8]"}},
      {entry("\"F32\"", "[2]", "[-8,0]"), 8, {"a", "data_offsets [-8,0]"}},
      {entry("\"F32\"", "[2]", "[8,0]"), 8, {"a", "data_offsets [8, 0]"}},
      {entry("\"F32\"", "[3]", "[0,12]"), 8, {"a", "data_offsets [0, 12]", "8 bytes"}},
      {entry("\"F32\"", "[2]", "[18446744073709551608,18446744073709551615]"), 8, {"a", "8 bytes"}},
      {entry("\"F32\"", "[3]", "[0,8]"), 8, {"a", "8 bytes", "F32", "[3]"}},
      {entry("\"F16\"", "[2]", "[0,8]"), 8, {"a", "8 bytes", "F16"}},
      // 2^62 floats and 2^33 x 2^31 of them: both have 0 bytes in 64 bits.
      {entry("\"F32\"", "[4611686018427387904]", "[0,0]"), 0, {"a", "0 bytes", "F32"}},
      {entry("\"F32\"", "[8589934592,2147483648]", "[0,0]"), 0, {"a", "0 bytes", "F32"}},
      {entry("\"F32\"", "[1]", "[4,8]"), 8, {"a", "byte 4", "0"}},
      {entry("\"F32\"", "[1]", "[0,4]"), 8, {"byte 4", "8"}},
      {R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]},)"
       R"("a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}})",
       4,
       {"a"}},
      {R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]},)"
       R"("b":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}})",
       4,
       {"byte 0", "4"}},
      {R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]},)"
       R"("b":{"dtype":"F32","shape":[2],"data_offsets":[4,12]}})",
       12,
       {"byte 4", "8"}},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.header.substr(0, 200));
    expect_reading(folder, file_bytes(c.header, c.data_bytes), c.names);
  }
}

TEST(Safetensors, PathsThatAreNoFilesAndTextsThatAreNoUtf8AreRefused) {
  const TemporaryFolder folder;
  for (const auto& path : {folder / "none", folder.path()}) {
    expect_refusal<CacheFileError>([&] { SafetensorsReader reader(path); }, {path.string()});
  }
  for (const auto& path : {folder.path(), std::filesystem::path("/dev/null"), folder / "none/file"}) {
    expect_refusal<OutputError>([&] { write_safetensors(path, {}, {}); }, {path.string()});
  }
  const Metadata no_text = {{"k", "\xff"}};
  expect_refusal<OutputError>([&] { write_safetensors(folder / "file", {}, no_text); }, {"file", "UTF-8"});
  EXPECT_EQ(folder.count_files(), 0u);
}

TEST(Safetensors, AnOldFileStaysWholeWhenTheDiskIsFull) {
  const TemporaryFolder folder;
  const auto path = folder.write("cache", "old");
  const std::vector<std::byte> zeros(100000);
  const std::vector<TensorView> tensors = {{"a", TensorType::f32, {25000}, zeros}};
  for (const rlim_t limit : {0u, 1u, 9u, 4096u, 70000u}) {
    const std::string what = [&] {
      const FileSizeLimit full(limit);
      return refusal<OutputError>([&] { write_safetensors(path, tensors, {}); });
    }();
    expect_message(what, {path.string()});
    EXPECT_EQ(read_file(path), "old");
    EXPECT_EQ(folder.count_files(), 1u);
  }
  // A small file is still in the buffer after the last write, so closing it fails.
  const std::string what = [&] {
    const FileSizeLimit full(5);
    return refusal<OutputError>([&] { write_safetensors(path, {}, {}); });
  }();
  expect_message(what, {path.string()});
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(folder.count_files(), 1u);
}

}  // namespace
}  // namespace gatelight
