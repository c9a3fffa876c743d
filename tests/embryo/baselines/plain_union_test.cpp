#include "baselines/embryo/plain_union.h"

#include <gtest/gtest.h>

#include "tests/embryo/surface/samples.h"

namespace geoprior::embryo {
namespace {

TEST(EmbryoPlainUnion, IsTheMeshOfWhatNeitherFusesNorDivides) {
  DayState day;
  day.structures = {{0, samples::ovoid({0, 0, 0}, {0.5, 0.7, 1}, 0.2)}, {4, samples::bent_duct()}};
  const std::vector<StructureMesh> sharp = plain_union(day), blended = day_meshes(day);
  ASSERT_EQ(sharp.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(sharp[i].mesh.V, blended[i].mesh.V);
    EXPECT_EQ(sharp[i].mesh.F, blended[i].mesh.F);
  }
}

TEST(EmbryoPlainUnion, OfAHorseshoeIsOneSurfaceWithLessInItsGrooves) {
  const StructureMesh sharp = plain_union(samples::horseshoe()).at(0),
                      blended = day_meshes(samples::horseshoe()).at(0);
  EXPECT_TRUE(samples::closed_manifold(sharp.mesh));
  EXPECT_EQ(samples::euler_number(sharp.mesh), 2);
  EXPECT_GT(signed_volume(blended.mesh.V, blended.mesh.F),
            1.01 * signed_volume(sharp.mesh.V, sharp.mesh.F));
}

/// Largest angle between the normals of two triangles at an edge (rad).
double sharpest_edge(const TriMesh& mesh) {
  const EdgeConnectivity edges(mesh.F);
  const Eigen::MatrixX3d normals = triangle_normals(mesh);
  double least = 1;
  for (int e = 0; e < edges.edge_count(); ++e)
    least = std::min(least, normals.row(edges.left(e)).dot(normals.row(edges.right(e))));
  return std::acos(least);
}

TEST(EmbryoPlainUnion, HasCreasesThatABlendHasNot) {
  SurfaceOptions fine;
  fine.cell = 0.4;
  EXPECT_GT(sharpest_edge(plain_union(samples::horseshoe(), fine).at(0).mesh),
            sharpest_edge(day_meshes(samples::horseshoe(), fine).at(0).mesh) + 0.2);
}

}  // namespace
}  // namespace geoprior::embryo
