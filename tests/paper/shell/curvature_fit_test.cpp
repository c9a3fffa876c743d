#include "core/geometry/curvature_fit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "tests/paper/meshes.h"

namespace geoprior::paper {
namespace {

using meshes::NamedMesh;

/// Graph of u' S u / 2 over the pattern, small enough for slopes to be angles.
Eigen::MatrixX3d quadratic(const Eigen::MatrixX2d& pattern, const Eigen::Vector3d& S) {
  Eigen::MatrixX3d x(pattern.rows(), 3);
  for (Eigen::Index v = 0; v < pattern.rows(); ++v) {
    const double p = pattern(v, 0), q = pattern(v, 1);
    x.row(v) << p, q, 0.5 * (S[0] * p * p + 2 * S[1] * p * q + S[2] * q * q);
  }
  return x;
}

std::vector<NamedMesh> sheets() {
  std::vector<NamedMesh> kinds = meshes::every_kind();
  std::erase_if(kinds,
                [](const NamedMesh& m) { return m.name.find("strips") != std::string::npos; });
  // Two cells wide: no triangle is away from the border, some are ears.
  kinds.push_back({"narrow grid", meshes::grid(12, 2, 1, 0.2, true)});
  kinds.push_back({"large random Delaunay", meshes::delaunay(24, 24, 1, 1, 5)});
  kinds.push_back({"turned grid", meshes::turned(meshes::grid(6, 6, 1, 1, false), 0.4)});
  return kinds;
}

TEST(DihedralAngle, IsPositiveInAValleySeenFromTheNormals) {
  // Two unit squares' halves about the x axis, both raised away from it by 30 degrees.
  const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
  Eigen::MatrixX3d x(4, 3);
  x << 0, 0, 0, 1, 0, 0, 0.3, c, s, 0.8, -c, s;
  const CurvatureFit::Hinge hinge{0, 1, 0, 1, 2, 3, Eigen::Vector3d::Zero()};
  EXPECT_NEAR(dihedral_angle(x, hinge), std::numbers::pi / 3, 1e-15);
  x.col(2) *= -1;
  EXPECT_NEAR(dihedral_angle(x, hinge), -std::numbers::pi / 3, 1e-15);
}

TEST(CurvatureFit, JumpIsTheAngleOfAQuadraticAcrossTheEdge) {
  const Eigen::Vector3d S(0.7, -0.4, 1.3);
  for (const auto& [name, mesh] : meshes::every_kind()) {
    const CurvatureFit fit = fit_curvature(mesh.pattern, mesh.triangles);
    const Eigen::MatrixX3d x = quadratic(mesh.pattern, 1e-5 * S);
    for (const auto& hinge : fit.hinges)
      EXPECT_NEAR(dihedral_angle(x, hinge) * 1e5, hinge.jump.dot(S), 1e-9) << name;
  }
}

// The patch test. 1e-5: slopes stand for angles up to their cube.
TEST(CurvatureFit, GivesConstantCurvatureOnEveryTriangleOfASheetWithBorders) {
  for (const auto& [name, mesh] : sheets()) {
    const CurvatureFit fit = fit_curvature(mesh.pattern, mesh.triangles);
    EXPECT_THAT(fit.rank, testing::Each(3)) << name;
    for (const Eigen::Vector3d& S :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.7, -0.4, 1.3)}) {
      const Eigen::MatrixX3d found = 1e5 * shape_operators(fit, quadratic(mesh.pattern, 1e-5 * S));
      EXPECT_LT((found.rowwise() - S.transpose()).cwiseAbs().maxCoeff(), 1e-8) << name;
    }
  }
}

// Over equal strips every angle of an exact cylinder is kappa times their width.
TEST(CurvatureFit, CylindersOverTheirRulingsAreCylinders) {
  for (const double slant : {0.0, 0.5, -1.2}) {
    const ShellMesh mesh = meshes::ruling_strips(9, 1, 1, slant);
    const CurvatureFit fit = fit_curvature(mesh.pattern, mesh.triangles);
    EXPECT_THAT(fit.rank, testing::Each(testing::Lt(3)));
    const Eigen::MatrixX3d x = meshes::rolled(mesh.pattern, 0.3, -std::atan(slant));
    const Eigen::Vector2d across = Eigen::Vector2d(1, -slant).normalized();
    const Eigen::RowVector3d S(across.x() * across.x(), across.x() * across.y(),
                               across.y() * across.y());
    EXPECT_LT((shape_operators(fit, x).rowwise() - 0.3 * S).cwiseAbs().maxCoeff(), 1e-12) << slant;
  }
}

// A known limit: the ends of the rulings are all there is of w = v^2 / 2.
TEST(CurvatureFit, UnbrokenRulingsDoNotSeeBendingAlongThem) {
  const ShellMesh mesh = meshes::ruling_strips(9, 1, 1, 0.5);
  const CurvatureFit fit = fit_curvature(mesh.pattern, mesh.triangles);
  const Eigen::MatrixX3d x = quadratic(mesh.pattern, {0, 0, 1e-5});
  EXPECT_LT(shape_operators(fit, x).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(CurvatureFit, TurnsWithThePattern) {
  const double angle = 0.7;
  Eigen::Matrix2d R;
  R << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  for (const auto& [name, mesh] : meshes::every_kind()) {
    const ShellMesh turned = meshes::turned(mesh, angle);
    Eigen::MatrixX3d x = quadratic(mesh.pattern, {0.2, 0.1, -0.3});
    x.col(2).array() += 0.05 * (3 * x.col(0)).array().sin();
    const Eigen::MatrixX3d S = shape_operators(fit_curvature(mesh.pattern, mesh.triangles), x);
    const Eigen::MatrixX3d T = shape_operators(fit_curvature(turned.pattern, turned.triangles), x);
    for (Eigen::Index t = 0; t < S.rows(); ++t) {
      Eigen::Matrix2d before, after;
      before << S(t, 0), S(t, 1), S(t, 1), S(t, 2);
      after << T(t, 0), T(t, 1), T(t, 1), T(t, 2);
      EXPECT_LT((R * before * R.transpose() - after).norm(), 1e-10) << name;
    }
  }
}

// The inverse must not blow up what constant curvature cannot represent: the norm of the fit of
// each triangle, in curvature per curvature of its edges, is that of a well-posed interpolation.
TEST(CurvatureFit, StaysBoundedOnRandomDelaunayMeshes) {
  const ShellMesh mesh = meshes::delaunay(24, 24, 1, 1, 3);
  const CurvatureFit fit = fit_curvature(mesh.pattern, mesh.triangles);
  for (const auto& terms : fit.terms) {
    double square = 0;
    for (const auto& term : terms)
      square += std::pow(term.coefficient.norm() * fit.hinges[term.hinge].jump.norm(), 2);
    EXPECT_LT(std::sqrt(square), 12);
  }
}

TEST(CurvatureFit, CountsOwnEdgesFirst) {
  const ShellMesh mesh = meshes::delaunay(6, 6, 1, 1);
  const CurvatureFit fit = fit_curvature(mesh.pattern, mesh.triangles);
  for (int t = 0; t < std::ssize(fit.terms); ++t) {
    EXPECT_LE(fit.terms[t].size(), static_cast<std::size_t>(CurvatureFit::kMostTerms));
    for (std::size_t i = 0; i < fit.terms[t].size(); ++i) {
      const auto& h = fit.hinges[fit.terms[t][i].hinge];
      const bool own = h.left == t || h.right == t;
      EXPECT_EQ(own, i < static_cast<std::size_t>(fit.own[t]));
    }
  }
}

TEST(CurvatureFit, OneTriangleHasNoCurvature) {
  Eigen::MatrixX2d pattern(3, 2);
  pattern << 0, 0, 1, 0, 0, 1;
  const Eigen::MatrixX3i triangle = Eigen::RowVector3i(0, 1, 2);
  const CurvatureFit fit = fit_curvature(pattern, triangle);
  EXPECT_TRUE(fit.hinges.empty());
  EXPECT_EQ(fit.rank.front(), 0);
  EXPECT_DOUBLE_EQ(fit.area.front(), 0.5);
}

std::string message_of(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& triangles) {
  try {
    fit_curvature(pattern, triangles);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(CurvatureFit, NamesBadTriangles) {
  Eigen::MatrixX2d pattern(5, 2);
  pattern << 0, 0, 1, 0, 1, 1, 0, 1, 2, 2;
  Eigen::MatrixX3i F(2, 3);
  F << 0, 1, 2, 0, 2, 4;
  EXPECT_THAT(message_of(pattern, F), testing::HasSubstr("triangle 1: triangle without area"));
  F << 0, 1, 2, 0, 3, 2;
  EXPECT_THAT(message_of(pattern, F), testing::HasSubstr("triangle 1: triangle turned over"));
  pattern.row(4) << 2, 0;
  F.resize(3, 3);
  F << 0, 1, 2, 0, 2, 3, 0, 4, 2;
  EXPECT_THAT(message_of(pattern, F), testing::HasSubstr("edge 0-2: edge that is not manifold"));
}

}  // namespace
}  // namespace geoprior::paper
