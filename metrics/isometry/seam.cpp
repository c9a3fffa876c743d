#include "metrics/isometry/seam.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"
#include "metrics/developability/quadric_fit.h"

namespace geoprior {
namespace {

Eigen::Vector3d doubled_area(const TriMesh& mesh, int t) {
  const Eigen::Vector3d a = mesh.V.row(mesh.F(t, 0)), b = mesh.V.row(mesh.F(t, 1)),
                        c = mesh.V.row(mesh.F(t, 2));
  return (b - a).cross(c - a);
}

void require_marks(const TriMesh& mesh, const std::vector<char>& marked) {
  if (std::ssize(marked) != mesh.vertex_count()) {
    throw Error(std::to_string(marked.size()) + " marks", "seam",
                std::to_string(mesh.vertex_count()) + ", one a vertex");
  }
}

/// A plane with its origin: columns of `axes` are two tangents and the normal.
struct SeamPlane {
  Eigen::Vector3d origin;
  Eigen::Matrix3d axes;
};

SeamPlane plane_with(const Eigen::Vector3d& origin, const Eigen::Vector3d& normal) {
  return {origin,
          Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix()};
}

/// A side of the seam, continued to the origin of the plane.
struct SeamSide {
  double height = 0;
  Eigen::Vector3d normal;
  double mean_curvature = 0;
};

/// Normal and mean curvature of the graph of a height with these derivatives.
SeamSide side_of(const Eigen::Matrix<double, 6, 1>& f) {
  const double u = f[QuadricFit::kU], v = f[QuadricFit::kV];
  const double area = std::sqrt(1 + u * u + v * v);
  const double curvature = ((1 + v * v) * f[QuadricFit::kUU] - 2 * u * v * f[QuadricFit::kUV] +
                            (1 + u * u) * f[QuadricFit::kVV]) /
                           (2 * area * area * area);
  return {f[QuadricFit::kValue], Eigen::Vector3d(-u, -v, 1) / area, curvature};
}

class SeamSides {
 public:
  SeamSides(const TriMesh& mesh, const std::vector<char>& marked)
      : mesh_(mesh), marked_(marked), corners_(mesh.F, mesh.vertex_count()) {}

  [[nodiscard]] std::optional<SeamJump> jump(int a, int b) const {
    const std::vector<int> near_a = around(a), near_b = around(b);
    const Eigen::Vector3d normal = normal_at(near_a) + normal_at(near_b);
    if (normal.norm() == 0) return std::nullopt;
    const SeamPlane plane =
        plane_with((mesh_.V.row(a) + mesh_.V.row(b)).transpose() / 2, normal.normalized());
    const std::optional<SeamSide> first = continued(near_a, plane);
    const std::optional<SeamSide> second = continued(near_b, plane);
    if (!first || !second) return std::nullopt;
    return SeamJump{
        std::abs(first->height - second->height),
        std::atan2(first->normal.cross(second->normal).norm(), first->normal.dot(second->normal)),
        std::abs(first->mean_curvature - second->mean_curvature)};
  }

 private:
  static constexpr int kRings = 2;
  static constexpr double kLeastCosine = 0.5;  // 60 degrees

  /// Vertices of the same side up to kRings edges away; ascending.
  [[nodiscard]] std::vector<int> around(int vertex) const {
    std::vector<int> found{vertex};
    for (int ring = 0; ring < kRings; ++ring) {
      std::vector<int> more;
      for (const int v : found)
        for (const int c : corners_.of(v))
          for (const int w : mesh_.F.row(c / 3))
            if (marked_[w] == marked_[vertex]) more.push_back(w);
      std::sort(more.begin(), more.end());
      more.erase(std::unique(more.begin(), more.end()), more.end());
      found = std::move(more);
    }
    return found;
  }

  /// Unit normal of the triangles of one side; 0 without any.
  [[nodiscard]] Eigen::Vector3d normal_at(const std::vector<int>& side) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const int v : side)
      for (const int c : corners_.of(v))
        if (is_of_one_side(c / 3)) sum += doubled_area(mesh_, c / 3);
    return sum.normalized();
  }
  [[nodiscard]] bool is_of_one_side(int t) const {
    const auto mark = [&](int k) { return marked_[mesh_.F(t, k)]; };
    return mark(0) == mark(1) && mark(1) == mark(2);
  }

  [[nodiscard]] std::optional<SeamSide> continued(const std::vector<int>& side,
                                                  const SeamPlane& plane) const {
    const Eigen::MatrixX3d local =
        (mesh_.V(side, Eigen::all).rowwise() - plane.origin.transpose()) * plane.axes;
    const std::optional<QuadricFit> fit = fit_quadric(local.leftCols<2>());
    if (!fit || fit->unobserved > 0) return std::nullopt;
    const SeamSide result = side_of(fit->weights.transpose() * local.col(2));
    if (result.normal.z() < kLeastCosine) return std::nullopt;
    return result;
  }

  const TriMesh& mesh_;
  const std::vector<char>& marked_;
  VertexCorners corners_;
};

}  // namespace

SeamJumps seam_jumps(const TriMesh& mesh, const std::vector<char>& marked) {
  require_marks(mesh, marked);
  std::vector<char> sides(marked.size());  // marks may be any numbers, sides are two
  std::transform(marked.begin(), marked.end(), sides.begin(), [](char m) { return m != 0; });
  const SeamSides seam(mesh, sides);
  SeamJumps jumps;
  const EdgeConnectivity connectivity(mesh.F);
  const auto add = [&](double SeamJump::*quantity, const SeamJump& jump) {
    jumps.rms.*quantity += jump.*quantity * jump.*quantity;
    jumps.largest.*quantity = std::max(jumps.largest.*quantity, jump.*quantity);
  };
  constexpr std::array kQuantities{&SeamJump::position, &SeamJump::angle, &SeamJump::curvature};
  for (const auto& [a, b] : connectivity.edges()) {
    if (sides[a] == sides[b]) continue;
    const std::optional<SeamJump> jump = seam.jump(a, b);
    if (!jump) continue;
    ++jumps.places;
    for (const auto quantity : kQuantities) add(quantity, *jump);
  }
  for (const auto quantity : kQuantities)
    jumps.rms.*quantity = std::sqrt(jumps.rms.*quantity / std::max(1, jumps.places));
  return jumps;
}

double largest_seam_angle(const TriMesh& mesh, const std::vector<char>& marked) {
  require_marks(mesh, marked);
  const auto is_marked = [&](int t) {
    const auto at = [&](int c) { return marked[mesh.F(t, c)] != 0; };
    return at(0) || at(1) || at(2);
  };
  const EdgeConnectivity connectivity(mesh.F);
  double largest = 0;
  for (int e = 0; e < connectivity.edge_count(); ++e) {
    const std::span<const int> both = connectivity.half_edges(e);
    if (both.size() != 2) continue;
    const int s = both[0] / 3, t = both[1] / 3;
    if (is_marked(s) == is_marked(t)) continue;
    const Eigen::Vector3d m = doubled_area(mesh, s), n = doubled_area(mesh, t);
    if (m.norm() == 0 || n.norm() == 0) continue;
    largest = std::max(largest, std::atan2(m.cross(n).norm(), m.dot(n)));
  }
  return largest;
}

}  // namespace geoprior
