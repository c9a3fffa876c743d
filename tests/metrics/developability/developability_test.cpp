#include "metrics/developability/developability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/error.h"
#include "metrics/isometry/isometry.h"
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

/// The lantern inscribed in a cylinder: n corners a ring, every other ring turned by half a step.
TriMesh schwarz_lantern(double radius, double height, int n, int bands) {
  TriMesh m;
  m.V.resize(n * (bands + 1), 3);
  m.F.resize(2 * n * bands, 3);
  for (int j = 0; j <= bands; ++j) {
    for (int i = 0; i < n; ++i) {
      const double t = 2 * pi * (i + (j % 2) / 2.0) / n;
      m.V.row(j * n + i) << radius * std::cos(t), radius * std::sin(t), height * j / bands;
    }
  }
  for (int j = 0; j < bands; ++j) {
    for (int i = 0; i < n; ++i) {
      const int next = (i + 1) % n, a = j * n, b = a + n, t = 2 * (a + i);
      if (j % 2 == 0) {
        m.F.row(t) << a + i, a + next, b + i;
        m.F.row(t + 1) << b + i, a + next, b + next;
      } else {
        m.F.row(t) << a + i, b + next, b + i;
        m.F.row(t + 1) << a + i, a + next, b + next;
      }
    }
  }
  return m;
}

/// Cone over a regular polygon, apex down at vertex 0, its sides rising by `slope`.
TriMesh polygonal_cone(double slope, int rings, int spokes) {
  sheets::Sheet s = sheets::disc(1, rings, spokes);
  s.x.col(2) = slope * s.pattern.rowwise().norm();
  return s.mesh();
}

/// Spherical cap about the z axis up to this polar angle.
TriMesh cap(double half_angle, int rings, int spokes) {
  const sheets::Sheet s = sheets::disc(half_angle, rings, spokes);
  return sheets::mapped(s,
                        [](const Eigen::Vector2d& p) -> Eigen::Vector3d {
                          const double t = p.norm();
                          if (!(t > 0)) return {0, 0, 1};
                          return {std::sin(t) * p(0) / t, std::sin(t) * p(1) / t, std::cos(t)};
                        })
      .mesh();
}

TEST(DevelopabilitySpread, TheSchwarzLanternIsCrumpledWithoutADefect) {
  // Six congruent isosceles triangles meet at a vertex, two by the angle at their tip and four by
  // one at their base: 2 pi in all. So it unfolds, however much area it has.
  const int n = 12, bands = 40;
  const DevelopabilitySpread d = developability_spread(schwarz_lantern(1, 2, n, bands));
  EXPECT_EQ(d.vertices, (bands - 1) * n);
  EXPECT_LT(d.defect_max, 1e-13);
  EXPECT_EQ(d.defect_flat_share, 1);
  // Normals lean by `lean` up and down, at the azimuth of the vertex and half a step to its sides,
  // so that E is diagonal; its part along the circle is the smallest here.
  const double sagitta = 1 - std::cos(pi / n), band = 2.0 / bands;
  const double lean = std::atan2(sagitta, band);
  const double base_angle = std::atan2(std::hypot(sagitta, band), std::sin(pi / n));
  const double energy = 4 * base_angle * std::pow(std::cos(lean) * std::sin(pi / n), 2);
  EXPECT_NEAR(d.hinge_median, energy, 1e-12);
  EXPECT_NEAR(d.hinge_sum, d.vertices * energy, 1e-9);
}

TEST(DevelopabilitySpread, OfAConeIsItsApexUntilThatIsLeftOut) {
  const int rings = 5, spokes = 36;
  const TriMesh mesh = polygonal_cone(0.75, rings, spokes);
  const DevelopabilitySpread d = developability_spread(mesh);
  // Chords of 2 sin(pi / n) between sides of length 1.25: the angle of a facet at the apex.
  const double apex = 2 * pi - spokes * 2 * std::asin(std::sin(pi / spokes) / 1.25);
  const int interior = 1 + (rings - 1) * spokes;
  EXPECT_EQ(d.vertices, interior);
  EXPECT_NEAR(d.defect_sum, apex, 1e-11);
  EXPECT_NEAR(d.defect_max, apex, 1e-12);
  EXPECT_LT(d.defect_median, 1e-13);
  EXPECT_LT(d.defect_p90, 1e-12);
  EXPECT_NEAR(d.defect_flat_share, 1 - 1.0 / interior, 1e-15);
  // The normals make one angle with the axis: twice sin^2 / 2 and, here larger, cos^2 of it.
  const double angle = std::atan(0.75 / std::cos(pi / spokes));
  EXPECT_NEAR(d.hinge_max, (2 * pi - apex) * std::pow(std::sin(angle), 2) / 2, 1e-12);
  EXPECT_NEAR(d.hinge_sum, d.hinge_max, 1e-11);
  std::vector<bool> left_out(mesh.vertex_count(), false);
  left_out[0] = true;
  const DevelopabilitySpread rest = developability_spread(mesh, left_out);
  EXPECT_EQ(rest.vertices, interior - 1);
  EXPECT_LT(rest.defect_sum, 1e-11);
  EXPECT_LT(rest.hinge_sum, 1e-11);
  EXPECT_EQ(rest.defect_flat_share, 1);
}

TEST(DevelopabilitySpread, OfAClosedSurfaceIsFourPiAtLeast) {
  // Gauss-Bonnet: equal for a convex one, more where there are saddles.
  EXPECT_NEAR(developability_spread(shapes::sphere(1, {0, 0, 0}, 4)).defect_sum, 4 * pi, 1e-9);
  EXPECT_NEAR(developability_spread(shapes::box({0, 0, 0}, {1, 2, 3})).defect_median, pi / 2,
              1e-12);
  const DevelopabilitySpread torus = developability_spread(shapes::torus(1, 0.3, 60, 24));
  EXPECT_GT(torus.defect_sum, 7.9 * pi);  // 4 pi outside and as much inside
  EXPECT_LT(torus.defect_sum, 8.1 * pi);
}

TEST(DevelopabilitySpread, QuantilesCountVertices) {
  // Ten apart pyramids of rising heights: their tips are the only interior vertices.
  TriMesh all = star({{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}});
  all.V(0, 2) = 0.1;
  const TriMesh one = all;
  std::vector<double> defect{angle_defect(one)(0)};
  for (int i = 2; i <= 10; ++i) {
    TriMesh next = one;
    next.V(0, 2) = 0.1 * i;
    defect.push_back(angle_defect(next)(0));
    all = shapes::together(all, next);
  }
  const DevelopabilitySpread d = developability_spread(all);
  EXPECT_EQ(d.vertices, 10);
  EXPECT_EQ(d.defect_median, defect[4]);
  EXPECT_EQ(d.defect_p90, defect[8]);
  EXPECT_EQ(d.defect_max, defect[9]);
}

TEST(DevelopabilitySpread, RefusesAMaskOfAnotherMesh) {
  const TriMesh mesh = polygonal_cone(0.5, 2, 6);
  EXPECT_THROW(developability_spread(mesh, std::vector<bool>(3)), Error);
  const DevelopabilitySpread none =
      developability_spread(mesh, std::vector<bool>(mesh.vertex_count(), true));
  EXPECT_EQ(none.vertices, 0);
  EXPECT_EQ(none.defect_flat_share, 1);
}

TEST(GaussImage, OfACylinderIsAGreatCircle) {
  TriMesh mesh =
      sheets::mapped(sheets::rectangle(0.3, 0.2, 24, 6, 0.2), sheets::cylinder(0.06)).mesh();
  // Inside vertices moved along the sheet: facets are not quite parallel to the axis.
  EXPECT_LT(gauss_image(mesh).great_circle_thinness, 2e-3);
  mesh = sheets::mapped(sheets::rectangle(0.3, 0.2, 24, 6), sheets::cylinder(0.06)).mesh();
  const GaussImage g = gauss_image(mesh);
  EXPECT_LT(g.great_circle_thinness, 1e-12);
  EXPECT_LT(g.small_circle_thinness, 1e-12);
  EXPECT_LT(g.great_circle_rms, 1e-7);
  EXPECT_LT(g.small_circle_rms, 1e-7);
  EXPECT_NEAR(std::abs(g.axis.y()), 1, 1e-12);
  EXPECT_NEAR(g.half_angle, pi / 2, 1e-7);
}

TEST(GaussImage, OfAConeIsASmallCircle) {
  // Facets rise by the slope over the polygon's inner radius, so all normals make this angle with
  // the axis; E[n n'] has the eigenvalues cos^2 and twice sin^2 / 2.
  const int spokes = 60;
  const double slope = 2.5;
  const double angle = std::atan(slope / std::cos(pi / spokes));
  const GaussImage g = gauss_image(polygonal_cone(slope, 3, spokes));
  EXPECT_NEAR(g.great_circle_thinness, 2 / std::pow(std::tan(angle), 2), 1e-12);
  EXPECT_LT(g.small_circle_thinness, 1e-12);
  EXPECT_NEAR(g.great_circle_rms, pi / 2 - angle, 1e-12);
  EXPECT_LT(g.small_circle_rms, 1e-7);
  EXPECT_NEAR(g.half_angle, angle, 1e-12);
  EXPECT_NEAR(std::abs(g.axis.z()), 1, 1e-12);
}

TEST(GaussImage, OfASphericalCapIsThatOfADisc) {
  for (const double half_angle : {0.3, 1.2}) {
    const double c = std::cos(half_angle);
    const GaussImage g = gauss_image(cap(half_angle, 60, 180));
    EXPECT_NEAR(g.great_circle_thinness, 1, 1e-9);
    const double disc = (1 - c) / (2 * (2 + c));
    EXPECT_NEAR(g.small_circle_thinness / disc, 1, 2e-3);
  }
  // Small: the mean of r over a disc is 2/3 of its radius, of r^2 a half.
  EXPECT_NEAR(gauss_image(cap(0.1, 60, 180)).small_circle_rms / 0.1, std::sqrt(0.5 - 4.0 / 9),
              2e-3);
  const GaussImage sphere = gauss_image(shapes::sphere(1, {0, 0, 0}, 4));
  EXPECT_NEAR(sphere.great_circle_thinness, 1, 1e-9);
  EXPECT_NEAR(sphere.small_circle_thinness, 1, 1e-9);
}

TEST(GaussImage, OfAPlaneAndAFoldIsAPointOrTwo) {
  const GaussImage plane = gauss_image(sheets::rectangle(1, 1, 4, 4).mesh());
  EXPECT_EQ(plane.great_circle_thinness, 0);
  EXPECT_EQ(plane.small_circle_thinness, 0);
  EXPECT_LT(plane.great_circle_rms, 1e-7);
  const GaussImage fold = gauss_image(sheets::folded(1, 1, 6, 4, 0.8).mesh());
  EXPECT_LT(fold.great_circle_thinness, 1e-12);
  EXPECT_EQ(fold.small_circle_thinness, 0);
  EXPECT_LT(fold.small_circle_rms, 1e-7);
}

TEST(GaussImage, IsOfAPanelAndByArea) {
  // A large cylinder and a sphere: the cylinder alone is thin.
  const TriMesh cylinder =
      sheets::mapped(sheets::rectangle(3, 2, 12, 3), sheets::cylinder(0.6)).mesh();
  const TriMesh both = shapes::together(cylinder, shapes::sphere(0.01, {9, 9, 9}, 4));
  std::vector<int> panel(cylinder.triangle_count());
  for (int t = 0; t < cylinder.triangle_count(); ++t) panel[t] = t;
  EXPECT_LT(gauss_image(both, panel).great_circle_thinness, 1e-12);
  // The sphere has 2e-4 of the area and many more triangles.
  EXPECT_GT(gauss_image(both).great_circle_thinness, 1e-5);
  EXPECT_LT(gauss_image(both).great_circle_thinness, 1e-3);
  TriMesh nothing = cylinder;
  nothing.V.setZero();
  EXPECT_THROW(gauss_image(nothing), Error);
}

TEST(PanelImages, OfASphereBesideACylinderAreWeighedByArea) {
  // A cylinder has a great circle, thinness 0; a sphere none, thinness 1.
  const TriMesh cylinder =
      sheets::mapped(sheets::rectangle(0.3, 0.2, 24, 6), sheets::cylinder(0.06)).mesh();
  const TriMesh both = shapes::together(cylinder, shapes::sphere(0.1, {1, 0, 0}, 4));
  std::vector<std::vector<int>> panels(2);
  panels[0].resize(cylinder.triangle_count());
  std::iota(panels[0].begin(), panels[0].end(), 0);
  panels[1].resize(both.triangle_count() - cylinder.triangle_count());
  std::iota(panels[1].begin(), panels[1].end(), cylinder.triangle_count());
  const double bent = panel_area(both, panels[0]), round = panel_area(both, panels[1]);
  EXPECT_NEAR(bent, 0.06, 3e-3 * 0.06);         // 0.3 x 0.2
  EXPECT_NEAR(round, 0.04 * pi, 5e-3 * round);  // 4 pi r^2
  const PanelImages images = panel_images(both, panels);
  EXPECT_NEAR(images.great_circle_thinness, round / (bent + round), 1e-9);
  EXPECT_NEAR(images.small_circle_thinness, round / (bent + round), 1e-9);
  const GaussImage sphere = gauss_image(both, panels[1]);
  EXPECT_NEAR(images.circle_rms,
              std::min(sphere.great_circle_rms, sphere.small_circle_rms) * round / (bent + round),
              1e-7);
  EXPECT_THROW(panel_images(both, {}), Error);
}

}  // namespace
}  // namespace geoprior
