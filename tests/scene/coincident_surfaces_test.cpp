// Bodies that touch, and panes in the plane of other surfaces.

#include "scene/coincident_surfaces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "scene/coincident_instances.h"
#include "scene/nested_volumes.h"
#include "tests/support/materials.h"

namespace gatelight::scene {
namespace {

using testing::SceneBuilder;

/// The offset of rays at a distance of a metre from the origin, and the most that surfaces may move there.
constexpr float kOffset = 16.0f * 0x1p-23f, kMost = 100.0f * kOffset;

struct Shapes : SceneBuilder {
  int glass = material(testing::solid_glass());
  int pane = material(clear_glass());
  int matte = material(lambert(Color::Constant(0.5f)));

  /// Returns the number of the instance.
  std::size_t body(const Vec3& low, const Vec3& high) {
    box(glass, low, high);
    return last();
  }
  /// A square around the z axis. Its front looks up, or down.
  std::size_t square(int of, float half, float z, bool down = false) {
    const Vec3 right(2.0f * half, 0, 0), back(0, 2.0f * half, 0);
    quad(of, Vec3(-half, -half, z), down ? back : right, down ? right : back);
    return last();
  }
  std::size_t last() {
    scene().instances.back().placement = static_cast<int>(scene().instances.size()) - 1;
    return scene().instances.size() - 1;
  }
  Box box_of(std::size_t i) {
    const Instance& instance = scene().instances[i];
    Box box;
    for (const Vec3& p : scene().mesh_of(instance).positions) box.extend(instance.transform * p);
    return box;
  }
  void separate() { separate_coincident_surfaces(scene()); }
};

/// Expects `outer` to contain `inner` with a margin that rays do not skip, and that no picture shows.
void expect_around(const Box& outer, const Box& inner) {
  const Vec3 below = inner.min() - outer.min(), above = outer.max() - inner.max();
  EXPECT_GT(std::min(below.minCoeff(), above.minCoeff()), kOffset);
  EXPECT_LT(std::max(below.maxCoeff(), above.maxCoeff()), kMost);
}

/// Expects the boxes to overlap a little along an axis. The first is below.
void expect_overlap(const Box& below, const Box& above, Eigen::Index axis) {
  EXPECT_GT(below.max()[axis] - above.min()[axis], 2.0f * kOffset);
  EXPECT_LT(below.max()[axis] - above.min()[axis], kMost);
}

TEST(CoincidentInstances, SayWhichFacesLookTheSameWay) {
  Shapes shapes;
  const auto low = static_cast<std::uint32_t>(shapes.body(Vec3(0, 0, 0), Vec3(1, 1, 1)));
  const auto high = static_cast<std::uint32_t>(shapes.body(Vec3(0, 0, 1), Vec3(2, 1, 2)));
  const auto far = static_cast<std::uint32_t>(shapes.body(Vec3(5, 0, 0), Vec3(6, 1, 1)));
  const auto table = static_cast<std::uint32_t>(shapes.square(shapes.matte, 3, 0));
  const CoincidentInstances found = find_coincident_instances(shapes.scene());
  ASSERT_EQ(found.pairs.size(), 3u) << far;
  for (const InstancePair pair :
       {InstancePair{low, high}, InstancePair{high, low}, InstancePair{low, table}}) {
    ASSERT_TRUE(found.pairs.contains(pair)) << pair.passing << " " << pair.other;
    EXPECT_TRUE(found.pairs.at(pair).opposite);
    EXPECT_FALSE(found.pairs.at(pair).same);
  }
}

TEST(TouchingBodies, OverlapInEitherOrder) {
  for (const bool right_first : {false, true}) {
    Shapes shapes;
    const Box left(Vec3(0, 0, 0), Vec3(0.5f, 1, 1)), right(Vec3(0.5f, 0.2f, 0.2f), Vec3(1, 0.8f, 0.8f));
    const std::array boxes = {right_first ? right : left, right_first ? left : right};
    for (const Box& each : boxes) shapes.body(each.min(), each.max());
    shapes.separate();
    for (const std::size_t i : {0u, 1u}) expect_around(shapes.box_of(i), boxes[i]);
    expect_overlap(shapes.box_of(right_first ? 1 : 0), shapes.box_of(right_first ? 0 : 1), 0);
  }
}

TEST(TouchingBodies, OfARowAllOverlap) {
  std::array<std::size_t, 3> order = {0, 1, 2};
  do {
    Shapes shapes;
    std::array<std::size_t, 3> number{};
    for (const std::size_t place : order) {
      const float x = 0.25f * static_cast<float>(place);
      number[place] = shapes.body(Vec3(x, 0, 0), Vec3(x + 0.25f, 0.5f, 0.5f));
    }
    shapes.separate();
    for (const std::size_t place : {0u, 1u})
      expect_overlap(shapes.box_of(number[place]), shapes.box_of(number[place + 1]), 0);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(TouchingBodies, MayBeInstancesOfOneMesh) {
  for (const bool mirrored : {false, true}) {
    Shapes shapes;
    shapes.body(Vec3(0, 0, 0), Vec3(0.5f, 0.5f, 0.5f));
    Instance& first = shapes.scene().instances[0];
    first.baked = false;
    Instance second = first;
    second.placement = 1;
    second.transform.translation() = Vec3(0.5f, 0, 0);
    if (mirrored) {
      second.transform.linear()(0, 0) = -1.0f;
      second.transform.translation() = Vec3(1, 0, 0);
      second.swaps_handedness = true;
    }
    shapes.scene().instances.push_back(second);
    const Box before = shapes.box_of(0);
    shapes.separate();
    expect_around(shapes.box_of(0), before);
    expect_overlap(shapes.box_of(0), shapes.box_of(1), 0);
  }
}

TEST(TouchingBodies, ThatAreMirroredOrScaledGrowOutwards) {
  for (const Vec3& scale : {Vec3(-1, 1, 1), Vec3(1, 1, -1), Vec3(0.01f, 0.01f, 0.01f), Vec3(-3, 3, 3)}) {
    Shapes shapes;
    const Vec3 half = 0.3f * scale.cwiseAbs().cwiseInverse();
    shapes.body(-half, half);
    Instance& instance = shapes.scene().instances[0];
    instance.baked = false;
    instance.transform.linear() = scale.asDiagonal();
    instance.swaps_handedness = scale.prod() < 0.0f;
    shapes.body(Vec3(0.3f, -1, -1), Vec3(1, 1, 1));
    const Box before = shapes.box_of(0);
    shapes.separate();
    SCOPED_TRACE(scale.transpose());
    expect_around(shapes.box_of(0), before);
    EXPECT_GT(enclosed_volume(shapes.scene(), 0), 0.0);
  }
}

TEST(TouchingBodies, OfOnePlacementGrowByThemselves) {
  // A beaker of glass, a closed shell, and the wine that fills it.
  for (const bool wine_first : {false, true}) {
    Shapes shapes;
    shapes.box(shapes.glass, Vec3(-0.5f, -0.5f, -0.5f), Vec3(0.5f, 0.5f, 0.5f));
    SceneBuilder inner;
    inner.box(0, Vec3(-0.4f, -0.4f, -0.4f), Vec3(0.4f, 0.4f, 0.4f), true);
    Mesh& shell = shapes.scene().meshes[0];
    for (const auto& [a, b, c] : inner.scene().meshes[0].triangles)
      shell.triangles.push_back({a + 8, b + 8, c + 8});
    for (const Vec3& p : inner.scene().meshes[0].positions) shell.positions.push_back(p);
    const int wine = shapes.material(testing::solid_glass(1.33f));
    shapes.box(wine, Vec3(-0.4f, -0.4f, -0.4f), Vec3(0.4f, 0.4f, 0.4f));
    std::vector<Instance>& instances = shapes.scene().instances;
    for (Instance& instance : instances) instance.placement = 5;
    if (wine_first) std::swap(instances[0], instances[1]);
    shapes.separate();
    const std::uint32_t glass = wine_first ? 1 : 0, filling = 1 - glass;
    Box cavity;
    for (std::size_t i = 8; i < 16; ++i) cavity.extend(shapes.scene().meshes[0].positions[i]);
    const Box old_cavity(Vec3::Constant(-0.4f), Vec3::Constant(0.4f));
    expect_around(old_cavity, cavity);
    expect_around(shapes.box_of(filling), old_cavity);
    expect_around(shapes.box_of(glass), Box(Vec3::Constant(-0.5f), Vec3::Constant(0.5f)));
    for (const std::uint32_t i : {glass, filling}) EXPECT_GT(enclosed_volume(shapes.scene(), i), 0.0);
  }
}

TEST(TouchingBodies, FlushInsideAnotherStayInside) {
  for (const bool inner_first : {false, true}) {
    Shapes shapes;
    const auto inner = [&] { shapes.body(Vec3(0, 0.2f, 0.2f), Vec3(0.4f, 0.5f, 0.4f)); };
    if (inner_first) inner();
    shapes.body(Vec3(0, 0, 0), Vec3(0.9f, 0.9f, 0.9f));
    if (!inner_first) inner();
    shapes.separate();
    const Box in = shapes.box_of(inner_first ? 0 : 1), out = shapes.box_of(inner_first ? 1 : 0);
    EXPECT_GT(in.min().x() - out.min().x(), kOffset);
    EXPECT_LT(in.min().x(), 0.0f) << "it grows, too";
    EXPECT_TRUE(out.contains(in));
  }
}

TEST(TouchingBodies, StandInTheTable) {
  Shapes shapes;
  const std::size_t table = shapes.square(shapes.matte, 0.9f, 0);
  const std::size_t glass = shapes.body(Vec3(-0.1f, -0.1f, 0), Vec3(0.1f, 0.1f, 0.3f));
  const Box before = shapes.box_of(table);
  shapes.separate();
  EXPECT_LT(shapes.box_of(glass).min().z(), -kOffset);
  EXPECT_TRUE(shapes.box_of(table).isApprox(before, 0.0f));
}

TEST(TouchingBodies, StayClosed) {
  // As files have them: each face with its own vertices.
  Shapes shapes;
  shapes.body(Vec3(-0.2f, -0.3f, 0), Vec3(0.2f, 0.3f, 0.1f));
  Mesh& mesh = shapes.scene().meshes[0];
  Mesh split = mesh;
  split.positions.clear();
  for (auto& corners : split.triangles) {
    for (std::uint32_t& corner : corners) {
      split.positions.push_back(mesh.positions[corner]);
      corner = static_cast<std::uint32_t>(split.positions.size()) - 1;
    }
  }
  const std::vector<std::array<std::uint32_t, 3>> welded = mesh.triangles;
  mesh = split;
  shapes.square(shapes.matte, 0.9f, 0);
  const double volume = enclosed_volume(shapes.scene(), 0);
  shapes.separate();
  EXPECT_GT(enclosed_volume(shapes.scene(), 0), volume);
  const Mesh& moved = shapes.scene().meshes[0];
  std::array<Vec3, 8> place;
  for (const bool store : {true, false}) {
    for (std::size_t t = 0; t < welded.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        Vec3& known = place[welded[t][k]];
        if (store) known = moved.positions[moved.triangles[t][k]];
        EXPECT_EQ(known, moved.positions[moved.triangles[t][k]]) << "corners stay together";
      }
    }
  }
}

/// A pane on a surface, with either front, before or after it in the file.
struct Laid : Shapes {
  std::size_t upper = 0, lower = 0;

  template <class Lower, class Upper>
  Laid(bool upper_first, const Lower& make_lower, const Upper& make_upper) {
    if (upper_first) upper = make_upper(*this);
    lower = make_lower(*this);
    if (!upper_first) upper = make_upper(*this);
    separate();
  }
};

TEST(Panes, LieBeforeTheSurfaceInTheirPlane) {
  for (const bool first : {false, true}) {
    for (const bool turned : {false, true}) {
      for (const bool down : {false, true}) {
        Laid laid(
            first, [&](Shapes& s) { return s.square(s.matte, 0.9f, 0.5f, down); },
            [&](Shapes& s) { return s.square(s.pane, 0.2f, 0.5f, turned); });
        SCOPED_TRACE(::testing::Message() << first << turned << down);
        const float height = (down ? -1.0f : 1.0f) * (laid.box_of(laid.upper).min().z() - 0.5f);
        EXPECT_GT(height, kOffset);
        EXPECT_LT(height, kMost);
        EXPECT_EQ(laid.box_of(laid.lower).max().z(), 0.5f);
      }
    }
  }
}

TEST(Panes, OnABodyLieOutsideOfIt) {
  for (const bool first : {false, true}) {
    for (const bool turned : {false, true}) {
      Laid laid(
          first,
          [&](Shapes& s) {
            s.square(s.matte, 3, 0);  // a large one, so that the body grows more
            return s.body(Vec3(-0.5f, -0.5f, 0), Vec3(0.5f, 0.5f, 0.4f));
          },
          [&](Shapes& s) { return s.square(s.pane, 0.2f, 0.4f, turned); });
      EXPECT_LT(laid.box_of(laid.lower).min().z(), -kOffset) << "the body grows into the table";
      EXPECT_GT(laid.box_of(laid.upper).min().z() - laid.box_of(laid.lower).max().z(), 0.4f * kOffset);
    }
  }
}

TEST(Panes, OnEachOtherSeparate) {
  for (const bool turned : {false, true}) {
    Shapes shapes;
    const std::size_t a = shapes.square(shapes.pane, 0.5f, 0.3f);
    const std::size_t b = shapes.square(shapes.pane, 0.4f, 0.3f, turned);
    const std::size_t c = shapes.square(shapes.pane, 0.3f, 0.3f);
    shapes.separate();
    std::array heights = {shapes.box_of(a).min().z(), shapes.box_of(b).min().z(), shapes.box_of(c).min().z()};
    std::sort(heights.begin(), heights.end());
    EXPECT_GT(heights[1] - heights[0], kOffset);
    EXPECT_GT(heights[2] - heights[1], kOffset);
    EXPECT_LT(heights[2] - heights[0], kMost);
  }
}

/// Expects separate() to leave all vertices as they are.
void expect_unmoved(Shapes& shapes) {
  const std::vector<Mesh> before = shapes.scene().meshes;
  shapes.separate();
  for (std::size_t m = 0; m < before.size(); ++m)
    EXPECT_TRUE(before[m].positions == shapes.scene().meshes[m].positions) << "mesh " << m;
}

TEST(OtherSurfaces, KeepTheirPlaces) {
  Shapes window;  // in a hole of the wall: they share an edge
  window.quad(window.matte, Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  window.quad(window.pane, Vec3(1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  window.quad(window.matte, Vec3(2, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  expect_unmoved(window);

  Shapes apart;
  apart.body(Vec3(0, 0, 0), Vec3(0.3f, 0.3f, 0.3f));
  apart.body(Vec3(0.301f, 0, 0), Vec3(0.6f, 0.3f, 0.3f));
  apart.body(Vec3(0.05f, 0.05f, 0.05f), Vec3(0.1f, 0.1f, 0.1f));
  apart.square(apart.pane, 0.5f, 0.7f);
  apart.square(apart.matte, 0.5f, 0.6999f);
  expect_unmoved(apart);

  Shapes across;  // planes that intersect
  across.body(Vec3(-0.3f, -0.3f, -0.3f), Vec3(0.3f, 0.3f, 0.3f));
  across.square(across.matte, 0.9f, 0.1f);
  across.square(across.pane, 0.9f, 0.2f);
  expect_unmoved(across);

  Shapes opaque;
  opaque.square(opaque.matte, 0.5f, 0.3f);
  opaque.square(opaque.matte, 0.4f, 0.3f);
  expect_unmoved(opaque);
}

TEST(OtherSurfaces, ThatDeformKeepTheirPlaces) {
  Shapes shapes;
  shapes.body(Vec3(0, 0, 0), Vec3(0.5f, 1, 1));
  shapes.body(Vec3(0.5f, 0, 0), Vec3(1, 1, 1));
  for (Mesh& mesh : shapes.scene().meshes) mesh.deforming = 0;
  expect_unmoved(shapes);
}

}  // namespace
}  // namespace gatelight::scene
