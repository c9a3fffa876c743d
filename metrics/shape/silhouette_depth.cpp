#include "metrics/shape/silhouette_depth.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/parallel.h"
#include "metrics/shape/projected_outline.h"

namespace geoprior {
namespace {

/// A contour edge in the view: right, up, depth towards the eye.
struct ContourEdge {
  Eigen::Vector3d a, b;
};

std::vector<ContourEdge> contour_edges(const TriMesh& mesh, const Eigen::Matrix3d& view) {
  const EdgeConnectivity edges(mesh.F);
  const Eigen::MatrixX3d X = mesh.V * view.transpose();
  const auto faces = [&](int t) {
    const Eigen::RowVector3d a = X.row(mesh.F(t, 0));
    const Eigen::RowVector3d n =
        (X.row(mesh.F(t, 1)) - a).cross(Eigen::RowVector3d(X.row(mesh.F(t, 2)) - a));
    return n.z() > 1e-9 * n.norm();
  };
  std::vector<ContourEdge> contour;
  for (int e = 0; e < edges.edge_count(); ++e) {
    const std::span<const int> both = edges.half_edges(e);
    if (both.size() == 2 && faces(both[0] / 3) == faces(both[1] / 3)) continue;
    contour.push_back({X.row(edges.edge(e)[0]).transpose(), X.row(edges.edge(e)[1]).transpose()});
  }
  return contour;
}

/// Depth of the contour's point that is nearest in the view; of equally near ones the first.
std::optional<double> nearest_depth(const std::vector<ContourEdge>& contour,
                                    const Eigen::Vector2d& p, double reach) {
  std::optional<double> depth;
  double nearest2 = reach * reach;
  for (const ContourEdge& edge : contour) {
    const Eigen::Vector2d a = edge.a.head<2>(), along = edge.b.head<2>() - a;
    const double length2 = along.squaredNorm();
    const double at = length2 > 0 ? std::clamp((p - a).dot(along) / length2, 0.0, 1.0) : 0.0;
    const double d2 = (a + at * along - p).squaredNorm();
    if (d2 >= nearest2) continue;
    nearest2 = d2;
    depth = edge.a.z() + at * (edge.b.z() - edge.a.z());
  }
  return depth;
}

std::vector<Eigen::Vector2d> evenly_spaced(const PlanarLoop& loop, int samples) {
  std::vector<double> arc{0};
  for (std::size_t i = 0; i < loop.size(); ++i)
    arc.push_back(arc.back() + (loop[(i + 1) % loop.size()] - loop[i]).norm());
  std::vector<Eigen::Vector2d> points;
  std::size_t segment = 0;
  for (int s = 0; s < samples; ++s) {
    const double at = arc.back() * s / samples;
    while (segment + 1 < loop.size() && arc[segment + 1] <= at) ++segment;
    const double share = (at - arc[segment]) / (arc[segment + 1] - arc[segment]);
    points.push_back(loop[segment] + share * (loop[(segment + 1) % loop.size()] - loop[segment]));
  }
  return points;
}

/// Root mean square distance of points from the plane that fits them best.
double distance_from_plane(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) spread += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[0]) / static_cast<double>(points.size()));
}

void summarise(const std::vector<Eigen::Vector2d>& points, double extent, double diagonal,
               double tail, SilhouetteDepth& result) {
  std::vector<double> depths;
  std::vector<Eigen::Vector3d> curve;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& now = result.depth[i];
    if (!now) continue;
    depths.push_back(*now);
    curve.emplace_back(points[i].x(), points[i].y(), *now);
    const auto& next = result.depth[(i + 1) % points.size()];
    if (next) result.jump = std::max(result.jump, std::abs(*next - *now) / extent);
  }
  if (depths.empty()) throw Error("no contour lies near", "silhouette depth", "at least one");
  std::sort(depths.begin(), depths.end());
  const auto left_out = static_cast<std::size_t>(tail * static_cast<double>(depths.size()));
  result.range = (depths[depths.size() - 1 - left_out] - depths[left_out]) / extent;
  result.plane_rms = distance_from_plane(curve) / diagonal;
}

}  // namespace

SilhouetteDepth silhouette_depth(const TriMesh& mesh, const Eigen::Matrix3d& view,
                                 const PlanarLoop& drawn, const SilhouetteDepthOptions& options) {
  if (drawn.size() < 3)
    throw Error(std::to_string(drawn.size()) + " points", "silhouette depth", "three or more");
  if (options.samples < 3 || !(options.reach > 0) || !(options.tail >= 0 && options.tail < 0.5))
    throw Error("options are out of range", "silhouette depth", "see their meaning");
  Eigen::Vector2d low = drawn.front(), high = drawn.front();
  for (const Eigen::Vector2d& p : drawn) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double diagonal = (high - low).norm();
  const std::vector<ContourEdge> contour = contour_edges(mesh, view);
  const std::vector<Eigen::Vector2d> points = evenly_spaced(drawn, options.samples);
  SilhouetteDepth result;
  result.depth.resize(points.size());
  parallel_blocks(points.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      result.depth[i] = nearest_depth(contour, points[i], options.reach * diagonal);
  });
  const Eigen::VectorXd depth = mesh.V * view.row(2).transpose();
  const double extent = depth.maxCoeff() - depth.minCoeff();
  if (!(extent > 0)) throw Error("surface has no depth", "silhouette depth", "a positive one");
  summarise(points, extent, diagonal, options.tail, result);
  return result;
}

}  // namespace geoprior
