#pragma once
// A triangle that one channel moves, or that channels can bend.

#include "tests/support/animated_file.h"

namespace gatelight::scene {

/// Moves its node by places at these seconds.
inline AnimatedFile translated_triangle(const AnimatedFile::Floats& seconds,
                                        const AnimatedFile::Floats& places,
                                        const char* interpolation = "LINEAR") {
  AnimatedFile file = moving_triangle();
  file.move(0, "translation", {file.seconds(seconds), file.vectors(places)}, interpolation);
  return file;
}

/// Turns its node by quaternions at these seconds.
inline AnimatedFile rotated_triangle(const AnimatedFile::Floats& seconds,
                                     const AnimatedFile::Floats& quaternions,
                                     const char* interpolation = "LINEAR") {
  AnimatedFile file = moving_triangle();
  file.move(0, "rotation", {file.seconds(seconds), file.quaternions(quaternions)}, interpolation);
  return file;
}

/// A triangle with two morph targets, which move its first vertex along x and y, and weights of
/// 0.25 and 0.5.
inline AnimatedFile morphing_triangle() {
  AnimatedFile file;
  json primitive = file.triangle();
  primitive["targets"] = {{{"POSITION", file.vectors({1, 0, 0, 0, 0, 0, 0, 0, 0})}},
                          {{"POSITION", file.vectors({0, 1, 0, 0, 0, 0, 0, 0, 0})}}};
  file.add("meshes", {{"primitives", {primitive}}, {"weights", {0.25, 0.5}}});
  file.node({{"mesh", 0}});
  return file;
}

}  // namespace gatelight::scene
