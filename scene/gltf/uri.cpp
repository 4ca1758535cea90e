#include "scene/gltf/uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>
#include <optional>

#include "scene/gltf/tinygltf.h"

namespace gatelight::scene::gltf {
namespace {

constexpr std::size_t kMaxBase64 = std::numeric_limits<int>::max();  // tinygltf counts in int

/// Whether the text begins with `prefix`, a text in lower case; ASCII letters of either case are equal.
bool begins_with(std::string_view text, std::string_view prefix) {
  return text.size() >= prefix.size() &&
         std::equal(prefix.begin(), prefix.end(), text.begin(),
                    [](char p, char t) { return p == (t >= 'A' && t <= 'Z' ? t + 32 : t); });
}

/// A % without two hexadecimal digits behind it is kept: files with such names exist.
std::string decode_percent(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    const char* digits = text.data() + i + 1;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2) {
      out.push_back(static_cast<char>(byte));
      i += 2;
    } else {
      out.push_back(text[i]);
    }
  }
  return out;
}

/// Returns nullopt if a character or the length is wrong. Padding is optional. tinygltf stops at the first
/// wrong character, so the number of bytes tells whether there is one.
std::optional<OwnedBytes> decode_base64(std::string_view text) {
  for (int pad = 0; pad < 2 && !text.empty() && text.back() == '='; ++pad) text.remove_suffix(1);
  if (text.empty()) return OwnedBytes();
  if (text.size() % 4 == 1) return std::nullopt;
  OwnedBytes out;
  std::string type;
  std::string uri = "data:application/octet-stream;base64,";
  uri += text;
  if (!tinygltf::DecodeDataURI(&out, type, uri, text.size() * 3 / 4, true)) return std::nullopt;
  return out;
}

/// Length of "scheme:" at the beginning (RFC 3986, section 3.1), or 0.
std::size_t scheme_length(std::string_view uri) {
  if (uri.empty() || !std::isalpha(static_cast<unsigned char>(uri[0]))) return 0;
  for (std::size_t i = 1; i < uri.size(); ++i) {
    const unsigned char c = static_cast<unsigned char>(uri[i]);
    if (c == ':') return i + 1;
    if (!std::isalnum(c) && c != '+' && c != '-' && c != '.') return 0;
  }
  return 0;
}

/// Of a name that may hold anything.
bool is_there(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::exists(path, error);
}

/// Whether the path lies outside the folder after resolving symbolic links. A missing file counts as inside.
bool leaves(const std::filesystem::path& folder, const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::path target = std::filesystem::canonical(path, error);
  if (error) return false;
  const std::filesystem::path root = std::filesystem::canonical(folder.empty() ? "." : folder, error);
  if (error) return true;
  return std::mismatch(root.begin(), root.end(), target.begin(), target.end()).first != root.end();
}

OwnedBytes read_data(std::string_view uri, std::string_view file, std::string_view where) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) {
    throw make_error(file, where, "a data URI without a comma, expected data:[type][;base64],content");
  }
  const std::string_view head = uri.substr(0, comma);
  const std::string_view body = uri.substr(comma + 1);
  constexpr std::string_view kBase64 = ";base64";
  if (begins_with(head.substr(head.size() - std::min(head.size(), kBase64.size())), kBase64)) {
    if (body.size() > kMaxBase64) {
      throw make_error(
          file, where,
          fmt::format("a data URI of {} characters, expected at most {}", body.size(), kMaxBase64));
    }
    std::optional<OwnedBytes> bytes = decode_base64(body);
    if (!bytes && body.find('%') != std::string_view::npos) bytes = decode_base64(decode_percent(body));
    if (!bytes) throw make_error(file, where, "a data URI that is not base64, expected base64");
    return std::move(*bytes);
  }
  const std::string text = decode_percent(body);
  return {text.begin(), text.end()};
}

}  // namespace

OwnedBytes read_uri(std::string_view uri, const UriOptions& options, std::string_view file,
                    std::string_view where, Warnings& warnings) {
  if (begins_with(uri, "data:")) return read_data(uri, file, where);
  const auto refuse = [&](std::string_view why) {
    return make_error(file, where,
                      fmt::format("'{}' {}, expected a file in the scene's folder{}", uri_name(uri), why,
                                  options.allow_external ? "" : " (others with `allow-external`)"));
  };
  if (uri.empty()) throw refuse("is empty");
  std::string_view rest = uri;
  if (const std::size_t scheme = scheme_length(uri); scheme > 0) {
    if (!options.allow_external || !begins_with(uri, "file:")) throw refuse("has a scheme");
    rest.remove_prefix(scheme);
    // Accepts "file:///path", "file://localhost/path" and "file:path"; another host is another machine.
    for (const std::string_view host : {"//localhost/", "///"}) {
      if (rest.starts_with(host)) rest.remove_prefix(host.size() - 1);
    }
    if (rest.starts_with("//")) throw refuse("is on another machine");
  }
  std::string name = decode_percent(rest);
  if (name.find('\\') != std::string::npos && !is_there(options.folder / name)) {
    warnings.add(
        fmt::format("{}: '{}' contains backslashes, which are read as slashes", where, uri_name(uri)));
    std::replace(name.begin(), name.end(), '\\', '/');
  }
  if (name.find('\0') != std::string::npos) throw refuse("has a zero byte");
  if (options.allow_external) return read_file(options.folder / name, file, where);
  const std::filesystem::path relative = std::filesystem::path(name).lexically_normal();
  if (relative.is_absolute()) throw refuse("is an absolute path");
  if (!relative.empty() && *relative.begin() == "..") throw refuse("leaves the folder");
  const std::filesystem::path path = options.folder / relative;
  if (leaves(options.folder, path)) throw refuse("is a symbolic link that leaves the folder");
  return read_file(path, file, where);
}

std::string uri_name(std::string_view uri) {
  if (begins_with(uri, "data:")) return one_line(uri.substr(0, std::min<std::size_t>(uri.find(','), 64)));
  return one_line(uri.substr(0, 256));
}

}  // namespace gatelight::scene::gltf
