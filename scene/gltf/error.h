#pragma once
// How the loader speaks: every refusal is one line, `<file>: <where>: <found>, expected <what>`.

#include <string>
#include <string_view>
#include <vector>

#include "scene/scene_error.h"

namespace gatelight::scene::gltf {

/// Text from a file made safe to print: control characters become spaces, what is too long is cut.
std::string one_line(std::string_view text);

/// `where` may be empty.
SceneError make_error(std::string_view file, std::string_view where, std::string_view what);

/// Collects warnings; the same sentence is kept once. Not for several threads: each task has its own, merged
/// in order, so that the list does not depend on the schedule.
class Warnings {
 public:
  void add(std::string_view text);
  void merge(const Warnings& other);
  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

}  // namespace gatelight::scene::gltf
