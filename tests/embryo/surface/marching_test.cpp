#include "models/embryo/surface/marching.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "metrics/contact/self_contact.h"
#include "tests/embryo/surface/samples.h"

namespace geoprior::embryo {
namespace {

using Eigen::Vector3d;

Lattice even_lattice(double edge) {
  Lattice lattice;
  lattice.spacing.setConstant(edge);
  return lattice;
}

TriMesh marched(const SolidField& field, double edge) {
  return march(field, even_lattice(edge), {}, "test").mesh;
}

/// Ovoids, a duct through them and a slot: creases and thin parts that the lattice does not fit.
SolidField crowded_field(double blend, bool sharp) {
  const Shape cut = samples::ovoid({0, 1, 0}, {0.4, 0.7, 0.8});
  Septum septum{{0.6, 0.8, 0}, cut.center, {0, 0, -1}, 0.1, 0.05, 0};
  return {
      {{0, samples::turned(samples::ovoid({0.8, 0, 0.5}, {0.3, 0.5, 0.9}, 0.3), 1, {1, 2, 3}), {}},
       {1, cut, septum},
       {2, samples::bent_duct(), {}},
       {3, samples::duct({{-1, -1, -1}, {0, -1, 0.3}, {1, 1, 1}}, 0.1, 0.05), {}}},
      blend,
      sharp};
}

TEST(EmbryoMarching, WhateverTheLatticeTheSurfaceIsAClosedManifoldThatMeetsItselfNowhere) {
  for (const bool sharp : {false, true})
    for (const double edge : {0.31, 0.13}) {
      const TriMesh mesh = marched(crowded_field(0.1, sharp), edge);
      ASSERT_GT(mesh.triangle_count(), 100);
      EXPECT_TRUE(samples::closed_manifold(mesh)) << edge;
      EXPECT_EQ(intersecting_pairs(mesh.V, mesh.F), 0) << edge;
      EXPECT_GT(signed_volume(mesh.V, mesh.F), 0) << "outward oriented";
    }
}

TEST(EmbryoMarching, LeavingOutBoxesChangesNoBit) {
  const SolidField field = crowded_field(0.1, false);
  Lattice graded = even_lattice(0.25);
  graded.axes = Eigen::AngleAxisd(0.4, Vector3d(1, 1, 2).normalized()).toRotationMatrix();
  graded.growth = {0.05, 0.1, 0};
  for (const Lattice& lattice : {even_lattice(0.17), graded}) {
    const MarchedSurface quick = march(field, lattice, {}, "test");
    MarchOptions plain;
    plain.skip = false;
    const MarchedSurface all = march(field, lattice, plain, "test");
    EXPECT_EQ(quick.mesh.V, all.mesh.V);
    EXPECT_EQ(quick.mesh.F, all.mesh.F);
    EXPECT_EQ(quick.member_of_triangle, all.member_of_triangle);
    EXPECT_LT(2 * quick.evaluations, all.evaluations);
  }
}

TEST(EmbryoMarching, BoxesGrowFromTheOriginAsTheyShould) {
  Lattice lattice = even_lattice(0.2);
  lattice.growth = {0.5, 0, 0};
  for (const double halves : {-20.0, -3.0, 0.0, 1.0, 15.0}) {
    const double x = lattice.place(0, halves);
    const double edge = (lattice.place(0, halves + 1e-4) - lattice.place(0, halves - 1e-4)) / 1e-4;
    EXPECT_NEAR(edge, std::hypot(0.2, 0.5 * x), 1e-6 * edge);
    EXPECT_NEAR(lattice.halves(0, x), halves, 1e-12);
    EXPECT_EQ(lattice.place(0, -halves), -x) << "its own mirror image";
    EXPECT_EQ(lattice.place(1, halves), 0.1 * halves);
  }
  const SolidField ball({{0, samples::ovoid({0.1, 0.2, 0.3}, {1, 1, 1}), {}}}, 0);
  const TriMesh mesh = march(ball, lattice, {}, "test").mesh;
  EXPECT_TRUE(samples::closed_manifold(mesh));
  EXPECT_EQ(intersecting_pairs(mesh.V, mesh.F), 0);
}

TEST(EmbryoMarching, VerticesLieOnTheSurfaceWithinWhatIsReported) {
  const Shape ball = samples::ovoid({0.1, 0.2, 0.3}, {1, 1, 1});
  const MarchedSurface surface = march(SolidField({{0, ball, {}}}, 0), even_lattice(0.3), {}, "");
  const Eigen::VectorXd off =
      ((surface.mesh.V.rowwise() - ball.center.transpose()).rowwise().norm().array() - 1).abs();
  EXPECT_LE(off.maxCoeff(), 1.01 * surface.deviation);
  EXPECT_LE(surface.deviation, 1e-3);
}

// The error of an inscribed surface goes with the square of the edge: a quarter for half of it.
TEST(EmbryoMarching, VolumeConvergesQuadratically) {
  const SolidField ball({{0, samples::ovoid({0.1, 0.2, 0.3}, {1, 1, 1}), {}}}, 0);
  const double exact = 4 * M_PI / 3;
  const TriMesh coarse = marched(ball, 0.3), fine = marched(ball, 0.15);
  const double first = exact - signed_volume(coarse.V, coarse.F),
               second = exact - signed_volume(fine.V, fine.F);
  EXPECT_NEAR(std::log2(first / second), 2, 0.2);
}

TEST(EmbryoMarching, AMirroredFieldGivesTheMirroredMesh) {
  Shape there = samples::bent_duct();
  const TriMesh a = marched(SolidField({{0, there, {}}}, 0), 0.08);
  const TriMesh b = marched(SolidField({{0, samples::mirrored(there), {}}}, 0), 0.08);
  ASSERT_EQ(a.triangle_count(), b.triangle_count());
  // Each triangle by its corners, the lowest first, in the order around it.
  const auto canonical = [](const TriMesh& mesh, double side) {
    std::vector<std::array<std::array<double, 3>, 3>> out;
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      std::array<std::array<double, 3>, 3> corners;
      for (int k = 0; k < 3; ++k) {
        const int v = mesh.F(t, side > 0 ? k : 2 - k);
        corners[k] = {side * mesh.V(v, 0), mesh.V(v, 1), mesh.V(v, 2)};
      }
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      out.push_back(corners);
    }
    std::sort(out.begin(), out.end());
    return out;
  };
  EXPECT_EQ(canonical(a, 1), canonical(b, -1)) << "to the last bit";
}

TEST(EmbryoMarching, RefusesMoreTrianglesThanAllowedAndBoxesBeyondItsKeys) {
  const SolidField ball({{0, samples::ovoid({0, 0, 0}, {1, 1, 1}), {}}}, 0);
  MarchOptions few;
  few.most_triangles = 500;
  const auto message = [&](double edge, const MarchOptions& options) {
    try {
      march(ball, even_lattice(edge), options, "structure 5");
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(0.1, few), testing::HasSubstr("structure 5: its surface needs too many"));
  EXPECT_THAT(message(1e-7, {}), testing::HasSubstr("too many cells"));
}

}  // namespace
}  // namespace geoprior::embryo
