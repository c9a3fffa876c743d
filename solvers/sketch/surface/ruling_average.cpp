#include "solvers/sketch/surface/ruling_average.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/geometry/topology.h"
#include "core/mesh.h"
#include "core/parallel.h"

namespace geoprior::sketch {
namespace {

constexpr double kAxisGuard = 30 * kDegree;

/// Direction of the ruling at a patch of normals: across the mean normal.
Eigen::Vector3d ruling_of(const Eigen::Matrix3d& moments, const Eigen::Vector3d& mean) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen;
  eigen.computeDirect(moments - mean * mean.transpose());
  const double most = std::cos(kAxisGuard) * mean.norm();
  int chosen = 0;
  while (chosen < 2 && std::abs(eigen.eigenvectors().col(chosen).dot(mean)) > most) ++chosen;
  const Eigen::Vector3d A = eigen.eigenvectors().col(chosen), up = mean.normalized();
  return (A - A.dot(up) * up).normalized();
}

}  // namespace

void describe(OptionVisitor& v, RulingAverageOptions& o) {
  v.value("share", o.share,
          {.doc = "share of the iterations, the first, that average normals along rulings",
           .min = 0,
           .max = 1});
  v.value(
      "reach", o.reach,
      {.doc = "radius within which normals tell the ruling, in edge lengths", .min = 1, .max = 10});
  v.value("across", o.across,
          {.doc = "half the width of an average across the ruling, in edge lengths",
           .min = 0.5,
           .max = 10});
  v.value("along", o.along,
          {.doc = "half the length of an average along the ruling, in edge lengths",
           .min = 0.5,
           .max = 10});
}

RulingAverage::RulingAverage(const Eigen::MatrixX3d& V, const Eigen::MatrixX3i& F,
                             const RulingAverageOptions& options)
    : F_(F) {
  const EdgeConnectivity edges(F);
  const double edge = mean_edge_length(V, edges);
  reach_ = options.reach * edge;
  across_ = options.across * edge;
  along_ = options.along * edge;
  const double farthest = std::max({reach_, across_, along_});
  const Triangles start = measured(V);
  begin_.assign(1, 0);
  std::vector<int> seen(F.rows(), -1);
  for (int t = 0; t < F.rows(); ++t) {
    std::size_t next = neighbour_.size();
    neighbour_.push_back(t);
    seen[t] = t;
    for (; next < neighbour_.size(); ++next) {
      for (int k = 0; k < 3; ++k) {
        const int other = edges.across(neighbour_[next], k);
        if (other < 0 || seen[other] == t) continue;
        if ((start.centre.row(other) - start.centre.row(t)).norm() > farthest) continue;
        seen[other] = t;
        neighbour_.push_back(other);
      }
    }
    begin_.push_back(static_cast<int>(neighbour_.size()));
  }
}

RulingAverage::Triangles RulingAverage::measured(const Eigen::MatrixX3d& X) const {
  Triangles all{Eigen::MatrixX3d(F_.rows(), 3), triangle_normals({X, F_}),
                Eigen::VectorXd(F_.rows())};
  for (Eigen::Index t = 0; t < F_.rows(); ++t) {
    const Eigen::Vector3d a = X.row(F_(t, 0)).transpose(), b = X.row(F_(t, 1)).transpose(),
                          c = X.row(F_(t, 2)).transpose();
    all.centre.row(t) = ((a + b + c) / 3).transpose();
    all.area(t) = (b - a).cross(c - a).norm() / 2;
  }
  return all;
}

Eigen::Vector3d RulingAverage::mean_normal(int triangle, const Triangles& all) const {
  const auto squared = [](double x) { return x * x; };
  const int begin = begin_[triangle], end = begin_[triangle + 1];
  const Eigen::RowVector3d here = all.centre.row(triangle);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  double sum = 0;
  for (int i = begin; i < end; ++i) {
    const int t = neighbour_[i];
    const double q = (all.centre.row(t) - here).squaredNorm() / squared(reach_);
    if (q >= 1) continue;
    const double w = all.area(t) * squared(1 - q);
    const Eigen::Vector3d n = all.normal.row(t).transpose();
    sum += w;
    mean += w * n;
    moments += w * n * n.transpose();
  }
  if (!(sum > 0) || !(mean.norm() > 1e-6 * sum)) return Eigen::Vector3d::Zero();
  const Eigen::Vector3d ruling = ruling_of(moments / sum, mean / sum);
  const Eigen::Vector3d across = mean.normalized().cross(ruling);
  Eigen::Vector3d average = Eigen::Vector3d::Zero();
  for (int i = begin; i < end; ++i) {
    const int t = neighbour_[i];
    const Eigen::Vector3d to = (all.centre.row(t) - here).transpose();
    const double q = squared(to.dot(across) / across_) + squared(to.dot(ruling) / along_);
    if (q < 1) average += all.area(t) * squared(1 - q) * all.normal.row(t).transpose();
  }
  return average.normalized();
}

std::vector<Eigen::Matrix3d> RulingAverage::rotations(const Eigen::MatrixX3d& X) const {
  const Triangles all = measured(X);
  std::vector<Eigen::Matrix3d> result(F_.rows(), Eigen::Matrix3d::Identity());
  parallel_blocks(result.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const int triangle = static_cast<int>(t);
      const Eigen::Vector3d mean = mean_normal(triangle, all);
      const Eigen::Vector3d n = all.normal.row(triangle).transpose();
      if (!mean.isZero() && n.dot(mean) > -0.99)
        result[t] = Eigen::Quaterniond::FromTwoVectors(n, mean).toRotationMatrix();
    }
  });
  return result;
}

}  // namespace geoprior::sketch
