#include "baselines/sketch/gauss_thinning/rotation_targets.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/error.h"
#include "core/random.h"
#include "models/sketch/surface/cotangent_weights.h"
#include "tests/sketch/surface/flow_shapes.h"

namespace geoprior::sketch {
namespace {

using flow_shapes::bumpy_sphere;

std::vector<Eigen::Matrix3d> equal_rotations(const TriMesh& mesh, const Eigen::Matrix3d& rotation) {
  return std::vector<Eigen::Matrix3d>(mesh.triangle_count(), rotation);
}

Eigen::Matrix3d a_rotation() {
  return Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
}

/// Rotated about the mean of the vertices.
Eigen::MatrixX3d turned(const Eigen::MatrixX3d& x, const Eigen::Matrix3d& rotation) {
  const Eigen::RowVector3d mean = x.colwise().mean();
  return ((x.rowwise() - mean) * rotation.transpose()).rowwise() + mean;
}

TEST(RotationPoisson, IdentitiesGiveTheMeshBack) {
  for (const TriMesh& mesh : {bumpy_sphere(3), flow_shapes::cone(), flow_shapes::tent()}) {
    for (const TriangleWeight weight : {TriangleWeight::area, TriangleWeight::uniform}) {
      const RotationPoisson poisson(mesh, weight);
      const auto still = equal_rotations(mesh, Eigen::Matrix3d::Identity());
      EXPECT_LT((poisson.solve(still) - mesh.V).cwiseAbs().maxCoeff(), 1e-12);
    }
  }
}

TEST(RotationPoisson, OneCommonRotationTurnsTheMeshAboutItsMean) {
  for (const TriMesh& mesh : {bumpy_sphere(3), flow_shapes::cone()}) {
    const Eigen::MatrixX3d expected = turned(mesh.V, a_rotation());
    const RotationPoisson poisson(mesh);
    EXPECT_LT((poisson.solve(equal_rotations(mesh, a_rotation())) - expected).cwiseAbs().maxCoeff(),
              1e-10);
  }
}

TEST(RotationPoisson, ComponentsAndLooseVerticesTurnEachAboutTheirOwnMean) {
  const TriMesh one = bumpy_sphere(2);
  TriMesh other = flow_shapes::cone();
  other.V.rowwise() += Eigen::RowVector3d(3, 1, -2);
  TriMesh both = shapes::together(one, other);
  both.V.conservativeResize(both.V.rows() + 1, 3);
  both.V.bottomRows<1>() << 7, 8, 9;
  const Eigen::MatrixX3d x = RotationPoisson(both).solve(equal_rotations(both, a_rotation()));
  EXPECT_LT((x.topRows(one.V.rows()) - turned(one.V, a_rotation())).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((x.middleRows(one.V.rows(), other.V.rows()) - turned(other.V, a_rotation()))
                .cwiseAbs()
                .maxCoeff(),
            1e-10);
  EXPECT_EQ(x.bottomRows<1>(), both.V.bottomRows<1>());
}

/// Eq. 2.2 as it is written, a fourth point to every triangle, by dense least squares: unknowns are
/// the vertices and then the fourth points, rows the nine entries of P' P^-1 - R of each triangle.
Eigen::MatrixX3d with_fourth_points(const TriMesh& mesh,
                                    const std::vector<Eigen::Matrix3d>& rotations) {
  const Eigen::Index n = mesh.V.rows(), m = mesh.F.rows();
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3 * m + 1, n + m);
  Eigen::MatrixX3d rhs = Eigen::MatrixX3d::Zero(3 * m + 1, 3);
  for (Eigen::Index t = 0; t < m; ++t) {
    const Eigen::Vector3d p1 = mesh.V.row(mesh.F(t, 0)), p2 = mesh.V.row(mesh.F(t, 1)),
                          p3 = mesh.V.row(mesh.F(t, 2));
    const Eigen::Vector3d p4 = p1 + (p2 - p1).cross(p3 - p1).normalized();
    Eigen::Matrix3d frame;
    frame << p4 - p1, p4 - p2, p4 - p3;
    const Eigen::Matrix3d inverse = frame.inverse();
    for (int column = 0; column < 3; ++column) {
      // (P' P^-1) column = sum_k (p4' - pk') inverse(k, column)
      for (int k = 0; k < 3; ++k) {
        rows(3 * t + column, mesh.F(t, k)) = -inverse(k, column);
        rows(3 * t + column, n + t) += inverse(k, column);
      }
      rhs.row(3 * t + column) = rotations[t].col(column).transpose();
    }
  }
  rows.row(3 * m).head(n).setConstant(1.0 / static_cast<double>(n));  // the mean stays
  rhs.row(3 * m) = mesh.V.colwise().mean();
  return rows.colPivHouseholderQr().solve(rhs).topRows(n);
}

TEST(RotationPoisson, UniformWeightsSolveEquation22WithItsFourthPoints) {
  const TriMesh mesh = flow_shapes::noisy(bumpy_sphere(1), 0.05);
  RandomStream random(2, "rotations");
  std::vector<Eigen::Matrix3d> rotations;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    rotations.push_back(
        Eigen::AngleAxisd(
            0.5 * random.normal(),
            Eigen::Vector3d(random.normal(), random.normal(), random.normal()).normalized())
            .toRotationMatrix());
  }
  const Eigen::MatrixX3d eliminated =
      RotationPoisson(mesh, TriangleWeight::uniform).solve(rotations);
  const Eigen::MatrixX3d written = with_fourth_points(mesh, rotations);
  EXPECT_LT((eliminated - written).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_GT((RotationPoisson(mesh).solve(rotations) - written).cwiseAbs().maxCoeff(), 1e-4)
      << "area weights are another fit";
}

TEST(RotationPoisson, NoPositionsNearTheSolutionHaveLessEnergy) {
  const TriMesh mesh = flow_shapes::noisy(flow_shapes::cone(), 0.01);
  RandomStream random(4, "turns");
  std::vector<Eigen::Matrix3d> rotations;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    rotations.push_back(
        Eigen::AngleAxisd(0.3 * random.normal(), Eigen::Vector3d::UnitY()).toRotationMatrix());
  }
  const RotationPoisson poisson(mesh);
  const TriMesh other = flow_shapes::noisy(mesh, 0.01);  // edges need not be those of the weights
  const Eigen::MatrixX3d best = poisson.solve(rotations, other.V);
  const double least = poisson.energy(rotations, other.V, best);
  EXPECT_GT(least, 0);
  for (int i = 0; i < 20; ++i) {
    Eigen::MatrixX3d move(best.rows(), 3);
    for (Eigen::Index v = 0; v < move.size(); ++v) move(v) = 1e-4 * random.normal();
    const double up = poisson.energy(rotations, other.V, best + move);
    const double down = poisson.energy(rotations, other.V, best - move);
    EXPECT_GT(std::min(up, down), least);
    EXPECT_NEAR(up, down, 1e-7 * up) << "the slope vanishes";
  }
}

TEST(RotationPoisson, RefusesWrongNumbersNamingBoth) {
  const TriMesh mesh = bumpy_sphere(1);
  const RotationPoisson poisson(mesh);
  EXPECT_THROW(static_cast<void>(poisson.solve(std::vector<Eigen::Matrix3d>(3))), Error);
  TriMesh broken = mesh;
  broken.F(0, 0) = 100000;
  EXPECT_THROW(RotationPoisson{broken}, Error);
}

TEST(CornerCotangents, OfTrueTrianglesAreCotangents) {
  TriMesh mesh;
  mesh.V.resize(3, 3);
  mesh.V << 0, 0, 0, 1, 0, 0, 0, 0.5, 0;
  mesh.F.resize(1, 3);
  mesh.F << 0, 1, 2;
  EXPECT_LT((corner_cotangents(mesh) - Eigen::RowVector3d(0, 2, 0.5)).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(CornerCotangents, OfSliversKeepTheEnergyConvex) {
  RandomStream random(6, "slivers");
  for (int i = 0; i < 2000; ++i) {
    TriMesh mesh;
    mesh.V = Eigen::MatrixX3d::Zero(3, 3);
    const double height = std::pow(10, -12 * random.uniform());
    mesh.V << 0, 0, 0, 1, 0, 0, 3 * random.uniform() - 1, height, 0;
    mesh.F.resize(1, 3);
    mesh.F << 0, 1, 2;
    const Eigen::RowVector3d c = corner_cotangents(mesh).row(0);
    EXPECT_LE(c.maxCoeff(), 20);
    EXPECT_GE(c(0) * c(1) + c(1) * c(2) + c(2) * c(0), -1e-12) << c;
    EXPECT_GE(c.sum(), 0);
  }
}

}  // namespace
}  // namespace geoprior::sketch
