#pragma once
// The loader's messages. Every error is one line: `<file>: <where>: <found>, expected <what>`.

#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "base/errors.h"

namespace gatelight::scene::gltf {

/// Makes text from a file safe to print: control characters become spaces, and long text is cut.
std::string one_line(std::string_view text);

/// Puts the message together; `where` may be empty.
InputError make_error(std::string_view file, std::string_view where, std::string_view what);

/// Collects warnings without duplicates. Lines that differ in their numbers only are alike: the first one
/// stands for all, with their count. Not thread-safe: each task has its own list, and the lists are merged in
/// order, so the result does not depend on the schedule.
class Warnings {
 public:
  void add(std::string_view text);
  void merge(const Warnings& other);
  std::vector<std::string> take();

 private:
  std::vector<std::vector<std::string>> alike_;         ///< in the order of their first lines
  std::unordered_map<std::string, std::size_t> kinds_;  ///< indices into alike_ by the line without numbers
  std::unordered_set<std::string> lines_;
};

}  // namespace gatelight::scene::gltf
