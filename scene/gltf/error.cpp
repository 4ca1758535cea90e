#include "scene/gltf/error.h"

#include <fmt/format.h>

namespace gatelight::scene::gltf {

std::string one_line(std::string_view text) {
  constexpr std::size_t kLongest = 1000;
  std::string line = gatelight::one_line(std::string(text.substr(0, kLongest)));
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

InputError make_error(std::string_view file, std::string_view where, std::string_view what) {
  return InputError(one_line(fmt::format("{}: {}{}{}", file, where, where.empty() ? "" : ": ", what)));
}

void Warnings::add(std::string_view text) {
  std::string line = one_line(text);
  if (!lines_.insert(line).second) return;
  std::string kind = line;
  std::erase_if(kind,
                [](char c) { return std::string_view("0123456789.+-").find(c) != std::string_view::npos; });
  const auto [entry, is_new] = kinds_.try_emplace(std::move(kind), alike_.size());
  if (is_new) alike_.emplace_back();
  alike_[entry->second].push_back(std::move(line));
}

void Warnings::merge(const Warnings& other) {
  for (const std::vector<std::string>& alike : other.alike_) {
    for (const std::string& line : alike) add(line);
  }
}

std::vector<std::string> Warnings::take() {
  std::vector<std::string> result;
  for (std::vector<std::string>& alike : alike_) {
    if (alike.size() > 1) alike.front() += fmt::format(" (and {} more like it)", alike.size() - 1);
    result.push_back(std::move(alike.front()));
  }
  *this = {};
  return result;
}

}  // namespace gatelight::scene::gltf
