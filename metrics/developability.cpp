#include "metrics/developability.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/angles.h"
#include "core/error.h"
#include "core/topology.h"

namespace geoprior {
namespace {

constexpr double kThin = kDegree;

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
  const auto n = static_cast<std::size_t>(mesh.vertex_count());
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

}  // namespace geoprior
