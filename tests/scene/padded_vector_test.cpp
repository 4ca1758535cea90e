#include "base/padded_vector.h"

#include <gtest/gtest.h>

#include <malloc.h>

#include <cstring>
#include <utility>

#include "scene/scene.h"

namespace gatelight::scene {
namespace {

/// Expects that 16 bytes can be read at the last position and belong to the vector. For six positions, 72
/// bytes, the C library's allocator would give no more than requested; the address sanitizer checks the read.
void expect_padding(const Mesh& mesh) {
  ASSERT_EQ(mesh.positions.size(), 6u);
  float read[4];
  std::memcpy(read, mesh.positions.data() + 5, sizeof(read));
  EXPECT_EQ(read[0], 5.0f);
  EXPECT_GE(malloc_usable_size(const_cast<Vec3*>(mesh.positions.data())), 5 * sizeof(Vec3) + sizeof(read));
}

Mesh six_positions() {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}};
  return mesh;
}

TEST(PaddedVector, ReadsOf16BytesStayInsideAfterCopiesMovesAndResizes) {
  Mesh mesh = six_positions();
  expect_padding(mesh);
  const Mesh copied = mesh;
  expect_padding(copied);
  Mesh assigned;
  assigned = copied;
  expect_padding(assigned);
  mesh.positions.resize(100);
  mesh.positions.resize(6);
  mesh.positions.shrink_to_fit();
  expect_padding(mesh);
  Mesh moved = std::move(mesh);
  expect_padding(moved);
  mesh = six_positions();
  expect_padding(mesh);
  mesh = std::move(moved);
  expect_padding(mesh);
  moved = copied;
  expect_padding(moved);
  std::vector<Mesh> grown(1, copied);
  grown.resize(9);
  expect_padding(grown.front());
}

}  // namespace
}  // namespace gatelight::scene
