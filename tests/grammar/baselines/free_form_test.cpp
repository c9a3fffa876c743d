#include "baselines/grammar/free_form.h"

#include <gtest/gtest.h>

#include "tests/testbed/scratch_folder.h"

namespace geoprior::grammar {
namespace {

/// A root with two sticks, the second below the first; each stick is a triangle with its corners
/// as key points.
Hierarchy two_sticks() {
  Hierarchy h;
  const int root = h.add_type({.name = "root"});
  const int stick =
      h.add_type({.name = "stick",
                  .keys =
                      [](std::span<const double>, std::vector<Eigen::Vector3d>& out) {
                        for (const double x : {0., .5, 1.}) out.emplace_back(x, x * x, 0);
                      },
                  .mesh =
                      [](std::span<const double>) {
                        TriMesh mesh{Eigen::MatrixX3d::Zero(3, 3), Eigen::MatrixX3i(1, 3)};
                        mesh.V.row(1) << .5, .25, 0;
                        mesh.V.row(2) << 1, 1, 0;
                        mesh.F << 0, 1, 2;
                        return mesh;
                      }});
  h.add(root, -1, {});
  h.add(stick, 0, {{0, 0, 0}});
  h.add(stick, 1, {{1, 1, 0}});
  return h;
}

AffineMap sheared_space() {
  Eigen::Affine3d shear = Eigen::Affine3d::Identity();
  shear.linear()(0, 2) = .7;
  shear.translation() = Eigen::Vector3d(.1, .2, .3);
  return AffineMap(shear);
}

TEST(GrammarFreeForm, EveryKeyAndVertexGoesWhereTheMapTakesIt) {
  const Geometry before = geometry_of(two_sticks(), true);
  const AffineMap map = sheared_space();
  const Geometry after = free_form(before, map);
  ASSERT_EQ(after.keys.rows(), 6);
  ASSERT_EQ(after.surface.vertex_count(), 6);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(after.keys.row(i).transpose(), map.at(before.keys.row(i).transpose()));
    EXPECT_EQ(after.surface.V.row(i).transpose(), map.at(before.surface.V.row(i).transpose()));
  }
  EXPECT_TRUE(same_triangles(after.surface.F, before.surface.F));
}

TEST(GrammarFreeForm, MovesASubtreeAndLeavesTheRestBitForBit) {
  const Hierarchy h = two_sticks();
  const Geometry before = geometry_of(h, true);
  EXPECT_EQ(elements_below(h, 1), (std::vector<char>{0, 1, 1}));
  const std::vector<char> moved = elements_below(h, 2);
  EXPECT_EQ(moved, (std::vector<char>{0, 0, 1}));
  const Geometry after = free_form(before, sheared_space(), moved);
  EXPECT_EQ(after.keys.topRows(3), before.keys.topRows(3));
  EXPECT_EQ(after.surface.V.topRows(3), before.surface.V.topRows(3));
  EXPECT_NE(after.keys.bottomRows(3), before.keys.bottomRows(3));
  EXPECT_NE(after.surface.V.bottomRows(3), before.surface.V.bottomRows(3));
}

TEST(GrammarFreeForm, AMaskHasANumberForEveryElement) {
  const Geometry before = geometry_of(two_sticks(), false);
  test::expect_error([&] { free_form(before, sheared_space(), std::vector<char>(2, 1)); },
                     {"has 2 numbers", "allowed: 3"});
}

}  // namespace
}  // namespace geoprior::grammar
