#include "base/file/safetensors.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/errors.h"
#include "base/file/atomic_file.h"

namespace gatelight {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "the format is little-endian, and so is this code");

constexpr const char* kMetadataKey = "__metadata__";
constexpr std::uint64_t kLengthBytes = 8;
/// Our headers have a few kilobytes. As JSON values a header takes up to a hundred times its size in memory.
constexpr std::uint64_t kMaxHeaderBytes = std::uint64_t{1} << 20;
/// The levels are the header, a tensor's entry and its shape. Deeper nesting could overflow the stack of code
/// that prints it.
constexpr int kMaxHeaderDepth = 3;
/// Names and bytes of the types, in the order of TensorType.
struct TypeTraits {
  std::string_view name;
  std::size_t bytes;
};
constexpr TypeTraits kTypes[] = {{"F16", 2}, {"F32", 4}, {"F64", 8}, {"U32", 4}, {"U64", 8}};

std::string_view type_name(TensorType type) {
  return kTypes[static_cast<std::size_t>(type)].name;
}

/// Computes the bytes of a tensor. Returns false if the number does not fit 64 bits.
bool tensor_bytes(TensorType type, std::span<const std::uint64_t> shape, std::uint64_t& bytes) {
  bytes = element_bytes(type);
  bool fits = true;
  for (const std::uint64_t extent : shape) fits = !__builtin_mul_overflow(bytes, extent, &bytes) && fits;
  return fits;
}

std::string shape_text(std::span<const std::uint64_t> shape) {
  return fmt::format("[{}]", fmt::join(shape, ", "));
}

/// Header text, padded so that the data begins at a multiple of eight bytes.
std::string header_text(std::span<const TensorView> tensors, const Metadata& metadata, const fs::path& path) {
  nlohmann::ordered_json header;
  if (!metadata.empty()) header[kMetadataKey] = metadata;
  std::uint64_t offset = 0;
  for (const TensorView& tensor : tensors) {
    nlohmann::ordered_json entry;
    entry["dtype"] = type_name(tensor.type);
    entry["shape"] = tensor.shape;
    entry["data_offsets"] = {offset, offset + tensor.data.size()};
    header[tensor.name] = std::move(entry);
    offset += tensor.data.size();
  }
  std::string text;
  try {
    text = header.dump();
  } catch (const json::type_error&) {
    throw OutputError(fmt::format("cannot write '{}': a text of the metadata is not UTF-8", path.string()));
  }
  text.resize((text.size() + 7) / 8 * 8, ' ');
  return text;
}

bool read_unsigned_array(const json& value, std::vector<std::uint64_t>& out) {
  if (!value.is_array()) return false;
  out.clear();
  for (const json& element : value) {
    if (!element.is_number_unsigned()) return false;
    out.push_back(element.get<std::uint64_t>());
  }
  return true;
}

}  // namespace

std::size_t element_bytes(TensorType type) {
  return kTypes[static_cast<std::size_t>(type)].bytes;
}

void write_safetensors(const ByteSink& sink, const fs::path& path, std::span<const TensorView> tensors,
                       const Metadata& metadata) {
  std::vector<TensorView> ordered(tensors.begin(), tensors.end());
  std::stable_sort(ordered.begin(), ordered.end(), [](const TensorView& a, const TensorView& b) {
    return element_bytes(a.type) > element_bytes(b.type);
  });
  for ([[maybe_unused]] const TensorView& tensor : ordered) {
    [[maybe_unused]] std::uint64_t bytes = 0;
    assert(tensor_bytes(tensor.type, tensor.shape, bytes) && bytes == tensor.data.size());
  }
  const std::string header = header_text(ordered, metadata, path);
  const std::uint64_t length = header.size();
  sink(std::as_bytes(std::span(&length, 1)));
  sink(std::as_bytes(std::span(header)));
  for (const TensorView& tensor : ordered) {
    if (!tensor.data.empty()) sink(tensor.data);
  }
}

void write_safetensors(const fs::path& path, std::span<const TensorView> tensors, const Metadata& metadata) {
  AtomicFile file(path);
  write_safetensors([&](std::span<const std::byte> bytes) { file.write(bytes.data(), bytes.size()); }, path,
                    tensors, metadata);
  file.commit();
}

SafetensorsReader::SafetensorsReader(const fs::path& path) : path_(path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) fail("it does not exist");
  if (!fs::is_regular_file(status)) fail("it is not a regular file");
  const std::uint64_t size = fs::file_size(path, error);
  if (error) fail(error.message());
  file_.open(path, std::ios::binary);
  if (!file_) fail("it cannot be opened");
  if (size < kLengthBytes)
    fail(fmt::format("{} bytes, expected at least the {} of the header's length", size, kLengthBytes));
  std::uint64_t length = 0;
  if (!file_.read(reinterpret_cast<char*>(&length), kLengthBytes)) fail("reading the header's length failed");
  const std::uint64_t most = std::min(size - kLengthBytes, kMaxHeaderBytes);
  if (length < 2 || length > most) fail(fmt::format("header of {} bytes, expected 2 to {}", length, most));
  std::string header(length, '\0');
  if (!file_.read(header.data(), static_cast<std::streamsize>(length))) fail("reading the header failed");
  data_offset_ = kLengthBytes + length;
  parse_header(header, size - data_offset_);
}

void SafetensorsReader::parse_header(const std::string& header, std::uint64_t data_bytes) {
  if (header.front() != '{') fail("the header does not begin with '{'");
  // The parser treats a NUL as the end of the text.
  if (header.find('\0') != std::string::npos) fail("the header holds a NUL byte");
  std::vector<std::set<std::string>> keys;
  std::string duplicate;
  const auto watch_keys = [&](int depth, json::parse_event_t event, json& parsed) {
    const bool opens =
        event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && depth >= kMaxHeaderDepth)
      fail(fmt::format("the header is nested deeper than {}", kMaxHeaderDepth));
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second)
      duplicate = parsed.get<std::string>();
    return true;
  };
  json root;
  try {
    root = json::parse(header, watch_keys);
  } catch (const json::exception& error) {
    fail(fmt::format("the header is no JSON: {}", error.what()));
  }
  if (!duplicate.empty()) fail(fmt::format("the header names '{}' twice", duplicate));

  for (const auto& [name, value] : root.items()) {
    if (!value.is_object()) fail(fmt::format("header entry '{}' is no object", name));
    if (name == kMetadataKey) {
      for (const auto& [key, text] : value.items()) {
        if (!text.is_string()) fail(fmt::format("metadata '{}' is no text", key));
        metadata_[key] = text.get<std::string>();
      }
      continue;
    }
    Entry entry;
    std::vector<std::uint64_t> offsets;
    if (value.size() != 3 || !value.contains("dtype") || !value.contains("shape") ||
        !value.contains("data_offsets"))
      fail(fmt::format("tensor '{}': expected dtype, shape and data_offsets", name));
    const json& word = value["dtype"];
    const auto* const type =
        std::ranges::find_if(kTypes, [&](const TypeTraits& t) { return word.is_string() && word == t.name; });
    if (type == std::ranges::end(kTypes))
      fail(fmt::format("tensor '{}': dtype {}, expected F16, F32, F64, U32 or U64", name, word.dump()));
    entry.type = static_cast<TensorType>(type - kTypes);
    if (!read_unsigned_array(value["shape"], entry.shape))
      fail(fmt::format("tensor '{}': shape {}, expected a list of whole numbers", name,
                       value["shape"].dump()));
    if (!read_unsigned_array(value["data_offsets"], offsets) || offsets.size() != 2)
      fail(fmt::format("tensor '{}': data_offsets {}, expected two whole numbers", name,
                       value["data_offsets"].dump()));
    entry.begin = offsets[0];
    entry.end = offsets[1];
    if (entry.begin > entry.end || entry.end > data_bytes)
      fail(fmt::format("tensor '{}': data_offsets [{}, {}], but the file holds {} bytes of data", name,
                       entry.begin, entry.end, data_bytes));
    std::uint64_t bytes = 0;
    if (!tensor_bytes(entry.type, entry.shape, bytes) || bytes != entry.end - entry.begin)
      fail(fmt::format("tensor '{}': {} bytes do not make {} of shape {}", name, entry.end - entry.begin,
                       type_name(entry.type), shape_text(entry.shape)));
    entries_.emplace(name, std::move(entry));
  }

  std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges;
  for (const auto& [name, entry] : entries_) ranges.emplace_back(entry.begin, entry.end);
  std::sort(ranges.begin(), ranges.end());
  std::uint64_t covered = 0;
  for (const auto& [begin, end] : ranges) {
    if (begin != covered)
      fail(fmt::format("a tensor begins at byte {} of the data, expected {}", begin, covered));
    covered = end;
  }
  if (covered != data_bytes)
    fail(fmt::format("the tensors end at byte {} of the data, expected {}", covered, data_bytes));
}

std::vector<std::string> SafetensorsReader::names() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries_) names.push_back(name);
  return names;
}

const SafetensorsReader::Entry& SafetensorsReader::find(const std::string& name) const {
  const auto found = entries_.find(name);
  if (found == entries_.end()) fail(fmt::format("tensor '{}' is missing", name));
  return found->second;
}

std::uint64_t SafetensorsReader::length(const std::string& name, TensorType type) const {
  const Entry& entry = find(name);
  if (entry.type != type || entry.shape.size() != 1)
    fail(fmt::format("tensor '{}': {} {}, expected {} [any]", name, type_name(entry.type),
                     shape_text(entry.shape), type_name(type)));
  return entry.shape[0];
}

void SafetensorsReader::expect_shape(const std::string& name, TensorType type,
                                     std::span<const std::uint64_t> shape) const {
  const Entry& entry = find(name);
  if (entry.type != type || !std::equal(shape.begin(), shape.end(), entry.shape.begin(), entry.shape.end()))
    fail(fmt::format("tensor '{}': {} {}, expected {} {}", name, type_name(entry.type),
                     shape_text(entry.shape), type_name(type), shape_text(shape)));
}

void SafetensorsReader::read(const std::string& name, TensorType type, std::span<const std::uint64_t> shape,
                             std::span<std::byte> out) {
  expect_shape(name, type, shape);
  const Entry& entry = find(name);
  assert(out.size() == entry.end - entry.begin);
  file_.seekg(static_cast<std::streamoff>(data_offset_ + entry.begin));
  if (!file_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size())))
    fail(fmt::format("reading tensor '{}' failed", name));
}

void SafetensorsReader::read_in_pieces(const std::string& name, const ByteSink& sink) {
  const Entry& entry = find(name);
  std::vector<std::byte> piece(std::min<std::uint64_t>(kPieceBytes, entry.end - entry.begin));
  file_.seekg(static_cast<std::streamoff>(data_offset_ + entry.begin));
  for (std::uint64_t left = entry.end - entry.begin; left > 0;) {
    const std::span bytes = std::span(piece).first(std::min<std::uint64_t>(left, piece.size()));
    if (!file_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
      fail(fmt::format("reading tensor '{}' failed", name));
    sink(bytes);
    left -= bytes.size();
  }
}

void SafetensorsReader::fail(const std::string& reason) const {
  constexpr std::size_t kLongest = 1000;
  throw CacheFileError(
      fmt::format("cannot read '{}': {}", path_.string(), one_line(reason.substr(0, kLongest))));
}

}  // namespace gatelight
