#include "scene/gltf/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace gatelight::scene::gltf {

std::string one_line(std::string_view text) {
  constexpr std::size_t kLongest = 1000;
  std::string line(text.substr(0, kLongest));
  for (char& c : line) {
    const unsigned char byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

InputError make_error(std::string_view file, std::string_view where, std::string_view what) {
  return InputError(one_line(fmt::format("{}: {}{}{}", file, where, where.empty() ? "" : ": ", what)));
}

void Warnings::add(std::string_view text) {
  std::string line = one_line(text);
  if (std::find(lines_.begin(), lines_.end(), line) == lines_.end()) lines_.push_back(std::move(line));
}

void Warnings::merge(const Warnings& other) {
  for (const std::string& line : other.lines_) add(line);
}

}  // namespace gatelight::scene::gltf
