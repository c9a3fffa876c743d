#include "baselines/sketch/shared/star_geometry.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"

namespace geoprior::sketch {
namespace {

constexpr std::size_t kStarsTogether = 512;

}  // namespace

StarGeometry::StarGeometry(const Eigen::MatrixX3i& F, int vertex_count) : F_(F) {
  const EdgeConnectivity checked(F);  // refuses negative indices
  if (F.size() > 0 && F.maxCoeff() >= vertex_count)
    throw Error("no vertex " + std::to_string(F.maxCoeff()), "stars of a mesh",
                "0 ... " + std::to_string(vertex_count - 1));
  corners_ = VertexCorners(F, vertex_count);
  border_ = boundary_vertices(F, vertex_count);
  angle_.setZero(corner_count());
  twice_area_.setZero(F.rows());
  normal_.setZero(3, F.rows());
  edge_.setZero(3, corner_count());
  at_corner_.setZero(3, corner_count());
}

void StarGeometry::measure_triangle(int t, const Eigen::MatrixX3d& x) {
  const Eigen::Vector3d a = x.row(F_(t, 0)), b = x.row(F_(t, 1)), c = x.row(F_(t, 2));
  const Eigen::Vector3d bc = c - b, ca = a - c, ab = b - a;
  const Eigen::Vector3d cross = ab.cross(bc);
  const double twice_area = cross.norm();
  twice_area_(t) = twice_area;
  normal_.col(t) = twice_area > 0 ? Eigen::Vector3d(cross / twice_area) : Eigen::Vector3d::Zero();
  edge_.col(3 * t) = bc;
  edge_.col(3 * t + 1) = ca;
  edge_.col(3 * t + 2) = ab;
  angle_(3 * t) = std::atan2(twice_area, -ab.dot(ca));
  angle_(3 * t + 1) = std::atan2(twice_area, -bc.dot(ab));
  angle_(3 * t + 2) = std::numbers::pi - angle_(3 * t) - angle_(3 * t + 1);
}

void StarGeometry::measure(const Eigen::MatrixX3d& x) {
  parallel_blocks(F_.rows(), kStarsTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) measure_triangle(static_cast<int>(t), x);
  });
}

void StarGeometry::differentiate_triangle(int t, const StarDerivatives& derivatives) {
  const int first = 3 * t;
  at_corner_.middleCols<3>(first).setZero();
  if (!(twice_area_(t) > 0)) return;
  const Eigen::Vector3d n = normal_.col(t);
  const Eigen::Vector3d by_normal = derivatives.by_normal.middleCols<3>(first).rowwise().sum();
  // n x e / |e|^2 of the three edges, the bricks of the derivatives of the angles.
  std::array<Eigen::Vector3d, 3> turned, brick;
  for (int k = 0; k < 3; ++k) {
    turned[k] = n.cross(edge_.col(first + k));
    brick[k] = turned[k] / edge_.col(first + k).squaredNorm();
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    // u = p_j - p_i is the edge opposite to k, and v = p_k - p_i minus the edge opposite to j.
    const double by_angle = derivatives.by_angle(first + i);
    at_corner_.col(first + j) -= by_angle * brick[k];
    at_corner_.col(first + k) -= by_angle * brick[j];
    at_corner_.col(first + i) += by_angle * (brick[j] + brick[k]);
    at_corner_.col(first + i) -= (turned[i].dot(by_normal) / twice_area_(t)) * n;
  }
}

void StarGeometry::gradient(const StarDerivatives& derivatives, Eigen::MatrixX3d& gradient) {
  parallel_blocks(F_.rows(), kStarsTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t)
      differentiate_triangle(static_cast<int>(t), derivatives);
  });
  gradient.resize(vertex_count(), 3);
  parallel_blocks(vertex_count(), kStarsTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const int c : corners_.of(static_cast<int>(v))) sum += at_corner_.col(c);
      gradient.row(v) = sum.transpose();
    }
  });
}

}  // namespace geoprior::sketch
