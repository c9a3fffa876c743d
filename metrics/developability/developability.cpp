#include "metrics/developability/developability.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "metrics/tracks/weighted_quantile.h"

namespace geoprior {
namespace {

constexpr double kThin = kDegree;
constexpr double kPointLike = 1e-10;  ///< second moment of a Gauss image that is a point or a pair

/// What the stars of all vertices add up to.
struct Stars {
  Eigen::VectorXd angle;                 ///< sum (rad)
  Eigen::VectorXd area;                  ///< a third of each triangle (m^2)
  std::vector<Eigen::Matrix3d> normals;  ///< sum of theta n n'
  std::vector<bool> interior;
};

/// Angle at the first of two sides, by atan2: accurate for thin triangles too.
double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Stars stars_of(const TriMesh& mesh, const Eigen::MatrixX3d& normal) {
  const std::size_t n = mesh.vertex_count();
  Stars stars;
  stars.angle = Eigen::VectorXd::Zero(mesh.vertex_count());
  stars.area = Eigen::VectorXd::Zero(mesh.vertex_count());
  stars.normals.assign(n, Eigen::Matrix3d::Zero());
  const std::vector<bool> border = boundary_vertices(mesh.F, mesh.vertex_count());
  stars.interior.assign(n, false);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::Matrix3d outer = normal.row(t).transpose() * normal.row(t);
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.F(t, k);
      const Eigen::Vector3d to_next =
          (mesh.V.row(mesh.F(t, (k + 1) % 3)) - mesh.V.row(v)).transpose();
      const Eigen::Vector3d to_last =
          (mesh.V.row(mesh.F(t, (k + 2) % 3)) - mesh.V.row(v)).transpose();
      const double angle = angle_between(to_next, to_last);
      stars.angle(v) += angle;
      stars.area(v) += to_next.cross(to_last).norm() / 6;
      stars.normals[v] += angle * outer;
      stars.interior[v] = !border[v];
    }
  }
  return stars;
}

/// Smallest eigenvalue of each interior star and its eigenvector, the axis of its great circle.
struct GreatCircles {
  Eigen::VectorXd energy;
  Eigen::MatrixX3d axis;
};

GreatCircles great_circles(const Stars& stars) {
  GreatCircles circles{Eigen::VectorXd::Zero(stars.angle.size()),
                       Eigen::MatrixX3d::Zero(stars.angle.size(), 3)};
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  for (Eigen::Index v = 0; v < stars.angle.size(); ++v) {
    if (!stars.interior[v]) continue;
    solver.compute(stars.normals[v]);
    circles.energy(v) = std::max(solver.eigenvalues()(0), 0.0);  // round-off below zero
    circles.axis.row(v) = solver.eigenvectors().col(0).transpose();
  }
  return circles;
}

Eigen::VectorXd defects(const Stars& stars) {
  Eigen::VectorXd defect = Eigen::VectorXd::Zero(stars.angle.size());
  for (Eigen::Index v = 0; v < defect.size(); ++v) {
    if (stars.interior[v]) {
      defect(v) = 2 * std::numbers::pi - stars.angle(v);
    }
  }
  return defect;
}

double thinness(const TriMesh& mesh, const Eigen::MatrixX3d& normal, const Stars& stars,
                const GreatCircles& circles, double tolerance) {
  std::vector<bool> thin = stars.interior;
  const double sine = std::sin(tolerance);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.F(t, k);
      if (std::abs(normal.row(t).dot(circles.axis.row(v))) > sine) {
        thin[v] = false;
      }
    }
  }
  double all = 0;
  double held = 0;
  for (Eigen::Index v = 0; v < stars.area.size(); ++v) {
    if (stars.interior[v]) all += stars.area(v);
    if (thin[v]) held += stars.area(v);
  }
  return all > 0 ? held / all : 1.0;
}

/// Normals of a panel with the weights that their triangles' areas give them.
struct WeightedNormals {
  std::vector<Eigen::Vector3d> normal;
  std::vector<double> weight;  ///< sum 1

  [[nodiscard]] Eigen::Vector3d mean() const {
    Eigen::Vector3d m = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < normal.size(); ++i) m += weight[i] * normal[i];
    return m;
  }
  /// E[(n - centre)(n - centre)'].
  [[nodiscard]] Eigen::Matrix3d moments(const Eigen::Vector3d& centre) const {
    Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < normal.size(); ++i) {
      const Eigen::Vector3d d = normal[i] - centre;
      m += weight[i] * (d * d.transpose());
    }
    return m;
  }
};

WeightedNormals weighted_normals(const TriMesh& mesh, std::span<const int> triangles) {
  std::vector<int> all;
  if (triangles.empty()) {
    all.resize(mesh.triangle_count());
    std::iota(all.begin(), all.end(), 0);
    triangles = all;
  }
  WeightedNormals normals;
  double total = 0;
  for (const int t : triangles) {
    const Eigen::RowVector3d a = mesh.V.row(mesh.F(t, 0));
    const Eigen::RowVector3d u = mesh.V.row(mesh.F(t, 1)) - a;
    const Eigen::RowVector3d v = mesh.V.row(mesh.F(t, 2)) - a;
    const Eigen::Vector3d twice_area = u.cross(v).transpose();
    const double weight = twice_area.norm();
    if (!(weight > 0)) continue;
    normals.normal.push_back(twice_area / weight);
    normals.weight.push_back(weight);
    total += weight;
  }
  if (!(total > 0)) throw Error("no triangle with an area", "Gauss image", "at least one");
  for (double& w : normals.weight) w /= total;
  return normals;
}

/// Smallest over middle eigenvalue; 0 where the image is a point or a pair of them.
double ratio_of_moments(const Eigen::Vector3d& ascending) {
  if (ascending(1) <= kPointLike) return 0;
  return std::max(ascending(0), 0.0) / ascending(1);
}

double angle_to(const Eigen::Vector3d& axis, const Eigen::Vector3d& normal) {
  return std::atan2(axis.cross(normal).norm(), axis.dot(normal));
}

/// Root mean square of the angles to the axis less `half_angle`.
double rms_from_circle(const WeightedNormals& image, const Eigen::Vector3d& axis,
                       double half_angle) {
  double sum = 0;
  for (std::size_t i = 0; i < image.normal.size(); ++i) {
    const double off = angle_to(axis, image.normal[i]) - half_angle;
    sum += image.weight[i] * off * off;
  }
  return std::sqrt(sum);
}

double mean_angle(const WeightedNormals& image, const Eigen::Vector3d& axis) {
  double sum = 0;
  for (std::size_t i = 0; i < image.normal.size(); ++i)
    sum += image.weight[i] * angle_to(axis, image.normal[i]);
  return sum;
}

/// Interior vertices that are not left out.
std::vector<Eigen::Index> counted_vertices(const Stars& stars, const std::vector<bool>& left_out) {
  std::vector<Eigen::Index> counted;
  for (std::size_t v = 0; v < stars.interior.size(); ++v) {
    if (stars.interior[v] && (left_out.empty() || !left_out[v])) counted.push_back(v);
  }
  return counted;
}

}  // namespace

Eigen::VectorXd angle_defect(const TriMesh& mesh) {
  return defects(stars_of(mesh, triangle_normals(mesh)));
}

Eigen::VectorXd hinge_energy(const TriMesh& mesh) {
  return great_circles(stars_of(mesh, triangle_normals(mesh))).energy;
}

double gauss_image_thinness(const TriMesh& mesh, double tolerance) {
  if (!(tolerance > 0)) throw Error("tolerance is not positive", "Gauss image", "above 0 rad");
  const Eigen::MatrixX3d normal = triangle_normals(mesh);
  const Stars stars = stars_of(mesh, normal);
  return thinness(mesh, normal, stars, great_circles(stars), tolerance);
}

DevelopabilitySummary developability(const TriMesh& mesh) {
  const Eigen::MatrixX3d normal = triangle_normals(mesh);
  const Stars stars = stars_of(mesh, normal);
  const GreatCircles circles = great_circles(stars);
  const Eigen::ArrayXd defect = defects(stars).array().abs();
  const auto interior = std::count(stars.interior.begin(), stars.interior.end(), true);
  DevelopabilitySummary summary;
  if (interior == 0) return summary;
  summary.angle_defect_mean = defect.sum() / static_cast<double>(interior);
  summary.angle_defect_max = defect.maxCoeff();
  summary.hinge_energy_sum = circles.energy.sum();
  summary.hinge_energy_max = circles.energy.maxCoeff();
  summary.thinness = thinness(mesh, normal, stars, circles, kThin);
  return summary;
}

DevelopabilitySpread developability_spread(const TriMesh& mesh, const std::vector<bool>& left_out) {
  if (!left_out.empty() && std::ssize(left_out) != mesh.vertex_count()) {
    throw Error(std::to_string(left_out.size()) + " marks", "developability",
                std::to_string(mesh.vertex_count()) + ", one a vertex, or none");
  }
  const Stars stars = stars_of(mesh, triangle_normals(mesh));
  const std::vector<Eigen::Index> counted = counted_vertices(stars, left_out);
  DevelopabilitySpread spread;
  if (counted.empty()) return spread;
  const Eigen::VectorXd defect = defects(stars)(counted).cwiseAbs();
  const Eigen::VectorXd energy = great_circles(stars).energy(counted);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(defect.size());
  const std::vector<double> quantiles = weighted_quantiles(defect, one, std::array{0.5, 0.9});
  spread.vertices = static_cast<int>(counted.size());
  spread.defect_sum = defect.sum();
  spread.defect_max = defect.maxCoeff();
  spread.defect_median = quantiles[0];
  spread.defect_p90 = quantiles[1];
  const auto flat = (defect.array() < kFlatDefect).count();
  spread.defect_flat_share = static_cast<double>(flat) / static_cast<double>(defect.size());
  spread.hinge_sum = energy.sum();
  spread.hinge_max = energy.maxCoeff();
  spread.hinge_median = weighted_quantile(energy, one, 0.5);
  return spread;
}

GaussImage gauss_image(const TriMesh& mesh, std::span<const int> triangles) {
  const WeightedNormals normals = weighted_normals(mesh, triangles);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> great(
      normals.moments(Eigen::Vector3d::Zero()));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> small(normals.moments(normals.mean()));
  GaussImage image;
  image.great_circle_thinness = ratio_of_moments(great.eigenvalues());
  image.small_circle_thinness = ratio_of_moments(small.eigenvalues());
  image.great_circle_rms =
      rms_from_circle(normals, great.eigenvectors().col(0), std::numbers::pi / 2);
  image.small_circle_rms = std::numeric_limits<double>::infinity();
  const std::array<Eigen::Vector3d, 4> axes{
      small.eigenvectors().col(0), small.eigenvectors().col(1), small.eigenvectors().col(2),
      great.eigenvectors().col(0)};
  for (const Eigen::Vector3d& axis : axes) {
    const double half_angle = mean_angle(normals, axis);
    const double rms = rms_from_circle(normals, axis, half_angle);
    if (rms < image.small_circle_rms) {
      image.small_circle_rms = rms;
      // Both ends of an axis have the same circle; the nearer one has the smaller angle.
      const bool near = half_angle <= std::numbers::pi / 2;
      image.axis = near ? axis : Eigen::Vector3d(-axis);
      image.half_angle = near ? half_angle : std::numbers::pi - half_angle;
    }
  }
  return image;
}

double panel_area(const TriMesh& mesh, std::span<const int> triangles) {
  double area = 0;
  for (const int t : triangles) {
    const Eigen::RowVector3d a = mesh.V.row(mesh.F(t, 0));
    const Eigen::RowVector3d u = mesh.V.row(mesh.F(t, 1)) - a, v = mesh.V.row(mesh.F(t, 2)) - a;
    area += u.cross(v).norm() / 2;
  }
  return area;
}

PanelImages panel_images(const TriMesh& mesh, std::span<const std::vector<int>> panels) {
  if (panels.empty()) throw Error("no panels", "Gauss image", "at least one");
  PanelImages sum;
  double whole = 0;
  for (const std::vector<int>& triangles : panels) {
    const GaussImage image = gauss_image(mesh, triangles);
    const double area = panel_area(mesh, triangles);
    sum.great_circle_thinness += area * image.great_circle_thinness;
    sum.small_circle_thinness += area * image.small_circle_thinness;
    sum.circle_rms += area * std::min(image.great_circle_rms, image.small_circle_rms);
    whole += area;
  }
  return {sum.great_circle_thinness / whole, sum.small_circle_thinness / whole,
          sum.circle_rms / whole};
}

}  // namespace geoprior
