#include "experiments/details/drawing/cut_holes.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/parallel.h"
#include "experiments/details/drawing/hole_chart.h"
#include "experiments/details/drawing/hole_mesh.h"
#include "experiments/details/drawing/smooth_normals.h"

namespace geoprior::details {
namespace {

/// Largest sum of two radii over the distance of their details. Chosen: what is left between two
/// holes is seen.
constexpr double kHoleSpacing = 0.85;

/// Holes are cut above this share of the radius. Chosen: smaller ones are not seen, and their
/// borders would be finer than all else in the mesh.
constexpr double kLeastHole = 0.04;

/// Radii that leave room between holes (see `cut_holes`).
std::vector<double> radii_apart(const std::vector<double>& wanted,
                                const std::vector<Eigen::Vector3d>& at,
                                const std::vector<Eigen::Vector3d>& normal) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < wanted.size(); ++i)
    if (wanted[i] > 0) order.push_back(i);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(at[a].x(), a) < std::pair(at[b].x(), b);
  });
  const double most = *std::max_element(wanted.begin(), wanted.end());
  std::vector<double> radius = wanted;
  for (std::size_t a = 0; a < order.size(); ++a) {
    const std::size_t i = order[a];
    for (std::size_t b = a + 1; b < order.size(); ++b) {
      const std::size_t j = order[b];
      if (kHoleSpacing * (at[j].x() - at[i].x()) > wanted[i] + most) break;
      // The other side of a thin part is near in space only.
      if (normal[i].dot(normal[j]) < 0) continue;
      const double overlap = wanted[i] + wanted[j] - kHoleSpacing * (at[i] - at[j]).norm();
      if (!(overlap > 0)) continue;
      const double wi = wanted[i] * wanted[i], wj = wanted[j] * wanted[j];
      radius[i] = std::min(radius[i], wanted[i] - overlap * wj / (wi + wj));
      radius[j] = std::min(radius[j], wanted[j] - overlap * wi / (wi + wj));
    }
  }
  return radius;
}

DrawnDetails compact(const HoledMesh& cut) {
  std::vector<int> number(cut.x.size(), -1);
  int count = 0;
  std::vector<char> used(cut.x.size(), 0);
  for (const auto& t : cut.triangle)
    for (const int v : t) used[v] = 1;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v] != 0) number[v] = count++;
  DrawnDetails drawn;
  drawn.mesh.V.resize(count, 3);
  drawn.normals.resize(count, 3);
  drawn.detail.resize(count);
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (number[v] < 0) continue;
    drawn.mesh.V.row(number[v]) = cut.x[v].transpose();
    drawn.normals.row(number[v]) = cut.normal[v].transpose();
    drawn.detail[number[v]] = cut.hole[v];
  }
  drawn.mesh.F.resize(cut.triangle.size(), 3);
  for (std::size_t t = 0; t < cut.triangle.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) drawn.mesh.F(t, k) = number[cut.triangle[t][k]];
  return drawn;
}

}  // namespace

CutSurface cut_holes(const SurfaceTopology& surface, std::span<const Eigen::Vector3d> x,
                     std::span<const DrawnAnchor> anchors, double radius) {
  const double least = kLeastHole * radius;
  const std::size_t n = anchors.size();
  const auto normals = normals_at(surface, x, anchors);
  std::vector<double> wanted(n);
  std::vector<Eigen::Vector3d> at(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double r = anchors[i].weight * radius;
    wanted[i] = r > least ? r : 0;
    at[i] = position_of(anchors[i].at, surface, x);
  }
  CutSurface result;
  result.radius.assign(n, 0);
  std::vector<double> apart = wanted;
  if (n > 0) apart = radii_apart(wanted, at, normals);
  std::vector<HoleChart> charts(n);
  parallel_blocks(n, 256, [&](std::size_t begin, std::size_t end) {
    HoleCharter charter(surface, x);
    for (std::size_t i = begin; i < end; ++i)
      if (apart[i] > least) charts[i] = charter.around(anchors[i], apart[i]);
  });
  HoleMesh mesh(surface, x, smooth_normals(surface, x));
  for (std::size_t i = 0; i < n; ++i) {
    if (!(charts[i].radius > least)) continue;
    result.radius[i] = charts[i].radius;
    mesh.add(static_cast<int>(i), charts[i]);
  }
  mesh.refine(kHoleSegments, least);
  for (std::size_t i = 0, added = 0; i < n; ++i)
    if (result.radius[i] > 0) result.radius[i] = mesh.radius(static_cast<int>(added++));
  result.drawn = compact(mesh.cut());
  return result;
}

}  // namespace geoprior::details
