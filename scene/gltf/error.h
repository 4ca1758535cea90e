#pragma once
// The loader's messages. Every error is one line: `<file>: <where>: <found>, expected <what>`.

#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace gatelight::scene::gltf {

/// Makes text from a file safe to print: control characters become spaces, and long text is cut.
std::string one_line(std::string_view text);

/// Puts the message together; `where` may be empty.
InputError make_error(std::string_view file, std::string_view where, std::string_view what);

/// Collects warnings without duplicates. Not thread-safe: each task has its own list, and the lists are
/// merged in order, so the result does not depend on the schedule.
class Warnings {
 public:
  void add(std::string_view text);
  void merge(const Warnings& other);
  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

}  // namespace gatelight::scene::gltf
