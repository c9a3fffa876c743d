#include "metrics/developability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "metrics/isometry.h"
#include "tests/metrics/shapes.h"
#include "tests/metrics/sheets.h"

namespace geoprior {
namespace {

using std::numbers::pi;

/// A vertex at the origin and neighbours about it, vertex 0.
TriMesh star(const std::vector<Eigen::Vector3d>& neighbours) {
  const int n = static_cast<int>(neighbours.size());
  TriMesh m;
  m.V = Eigen::MatrixX3d::Zero(n + 1, 3);
  m.F.resize(n, 3);
  for (int i = 0; i < n; ++i) {
    m.V.row(i + 1) = neighbours[i].transpose();
    m.F.row(i) << 0, i + 1, (i + 1) % n + 1;
  }
  return m;
}

TEST(Developability, APlaneHasNeitherDefectNorHingeEnergy) {
  const DevelopabilitySummary d = developability(sheets::rectangle(0.3, 0.2, 7, 6, 0.3).mesh());
  EXPECT_LT(d.angle_defect_max, 1e-14);
  EXPECT_LT(d.hinge_energy_max, 1e-15);
  EXPECT_EQ(d.thinness, 1);
}

TEST(Developability, ACylinderWithRulingsForEdgesHasNeither) {
  const DevelopabilitySummary d = developability(
      sheets::mapped(sheets::rectangle(0.3, 0.2, 9, 6), sheets::cylinder(0.06)).mesh());
  EXPECT_LT(d.angle_defect_max, 1e-13);
  EXPECT_LT(d.hinge_energy_max, 1e-14);
  EXPECT_EQ(d.thinness, 1);
}

TEST(Developability, OfAPyramidIsTheClosedForm) {
  // Six faces whose normals lean by `lean` from the axis.
  const double height = 0.4;
  std::vector<Eigen::Vector3d> ring;
  for (int i = 0; i < 6; ++i) {
    ring.emplace_back(std::cos(pi * i / 3), std::sin(pi * i / 3), -height);
  }
  const TriMesh m = star(ring);
  const double angle = 2 * std::asin(0.5 / std::hypot(1, height));  // of the unit sides at the apex
  const double lean = std::atan2(height, std::sqrt(3) / 2);
  EXPECT_NEAR(angle_defect(m)(0), 2 * pi - 6 * angle, 1e-14);
  EXPECT_NEAR(hinge_energy(m)(0), 3 * angle * std::pow(std::sin(lean), 2), 1e-14);
  EXPECT_EQ(angle_defect(m)(1), 0);  // border
  EXPECT_EQ(hinge_energy(m)(1), 0);
  EXPECT_EQ(gauss_image_thinness(m, 0.1), 0);
}

TEST(Developability, OfASaddleIsTheClosedForm) {
  const double h = 0.3;
  const TriMesh m = star({{1, 0, h}, {0, 1, -h}, {-1, 0, h}, {0, -1, -h}});
  const double angle = std::acos(-h * h / (1 + h * h));
  EXPECT_NEAR(angle_defect(m)(0), 2 * pi - 4 * angle, 1e-14);
  EXPECT_LT(angle_defect(m)(0), -0.1);
  EXPECT_NEAR(hinge_energy(m)(0), 4 * angle * h * h / (1 + 2 * h * h), 1e-14);
}

TEST(Developability, DefectsOfASphereAddUpToFourPi) {
  for (const int levels : {2, 4}) {
    const TriMesh m = shapes::sphere(0.3, {1, 2, 3}, levels);
    EXPECT_NEAR(angle_defect(m).sum(), 4 * pi, 1e-9);  // Gauss-Bonnet
    EXPECT_GT(angle_defect(m).minCoeff(), 0);
    EXPECT_GT(hinge_energy(m).minCoeff(), 0);
  }
  // On a regular triangular layout a star has pi l^2 / (3 R^2) and sqrt(3)/2 l^2 of area, so the
  // sum would be 8 pi^2 / (3 sqrt 3) = 15.2; the subdivided octahedron is not quite regular.
  const double regular = 8 * pi * pi / (3 * std::sqrt(3.0));
  EXPECT_NEAR(hinge_energy(shapes::sphere(1, {0, 0, 0}, 5)).sum() / regular, 1, 0.1);
  EXPECT_EQ(developability(shapes::sphere(1, {0, 0, 0}, 2)).thinness, 0);
}

TEST(Developability, CrumpledWithoutDefectIsSeenByTheHingeEnergyAlone) {
  const sheets::Miura m;
  const sheets::Sheet s = sheets::miura_ori(m);
  EXPECT_LT(isometry(s.pattern, s.x, s.triangles).max, 1e-7);
  const DevelopabilitySummary d = developability(s.mesh());
  EXPECT_LT(d.angle_defect_max, 1e-13);
  // The four normals are (+-VH, +-SH, SL): the first axis has the smallest eigenvalue.
  const double n2 = std::pow(m.V * m.H, 2) + std::pow(m.S * m.H, 2) + std::pow(m.S * m.L, 2);
  const double vertex = 2 * pi * std::pow(m.V * m.H, 2) / n2;
  EXPECT_NEAR(d.hinge_energy_max, vertex, 1e-13);
  EXPECT_NEAR(d.hinge_energy_sum, 81 * vertex, 1e-11);
  EXPECT_GT(vertex, 0.1);
  EXPECT_EQ(d.thinness, 0);
}

TEST(Developability, OfADConeIsAtItsApexAlone) {
  const sheets::Sheet s = sheets::mapped(sheets::disc(0.1, 3, 240), sheets::DCone(0.3, 2));
  const Eigen::VectorXd defect = angle_defect(s.mesh());
  const Eigen::VectorXd energy = hinge_energy(s.mesh());
  // The polygon inscribed in the curve of length 2 pi is shorter by sum of (arc^3 k_g^2)/24.
  EXPECT_NEAR(defect(0), 0, 2e-3);
  EXPECT_GT(energy(0), 0.1);
  // About other vertices only two of the six triangles' planes differ: a hinge.
  EXPECT_LT(defect.tail(defect.size() - 1).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT(energy.tail(energy.size() - 1).maxCoeff(), 1e-14);
}

TEST(Developability, DoesNotChangeWithPlaceAndScale) {
  const sheets::Sheet s = sheets::miura_ori();
  TriMesh moved = s.mesh();
  const Eigen::Matrix3d R =
      Eigen::AngleAxisd(1.3, Eigen::Vector3d(1, 2, 2).normalized()).toRotationMatrix();
  moved.V = (17 * moved.V * R.transpose()).rowwise() + Eigen::RowVector3d(1, -2, 3);
  EXPECT_LT((hinge_energy(moved) - hinge_energy(s.mesh())).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Developability, ThinnessIsAShareOfTheArea) {
  // One interior vertex of four is lifted; the others see it in their stars too unless apart.
  sheets::Sheet s = sheets::rectangle(1, 1, 12, 3);
  const int lifted = 3 * 4 + 1;
  s.x(lifted, 2) += 0.05;
  const double thin = gauss_image_thinness(s.mesh(), pi / 180);
  EXPECT_GT(thin, 0.5);
  EXPECT_LT(thin, 1 - 1.0 / 22);
  EXPECT_EQ(gauss_image_thinness(s.mesh(), 1.5), 1);
  EXPECT_THROW(gauss_image_thinness(s.mesh(), 0), Error);
}

TEST(Developability, WithoutInteriorVerticesThereIsNothingToSee) {
  const DevelopabilitySummary d = developability(sheets::rectangle(1, 1, 1, 1).mesh());
  EXPECT_EQ(d.angle_defect_mean, 0);
  EXPECT_EQ(d.thinness, 1);
}

}  // namespace
}  // namespace geoprior
