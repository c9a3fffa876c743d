#include "baselines/fluid/liquid/tank/shape_distance_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "core/connectivity.h"
#include "core/parallel.h"

namespace geoprior::fluid {
namespace {

constexpr double kBand = 2;  ///< cells with exact distances on both sides
constexpr int kMargin = 3;   ///< cells around the bounding box
constexpr double kMostNodes = 1 << 24;
constexpr float kUnknown = 1e30F;

/// Pseudonormals of the features of every triangle: the face, its vertices and edges (edge e joins
/// the corners e and e + 1). A point lies outside when its way from the nearest feature has a
/// positive product with that feature's normal.
struct Pseudonormals {
  Eigen::MatrixX3d face, vertex;
  std::vector<std::array<Eigen::Vector3d, 3>> edge;
};

Pseudonormals pseudonormals(const TriMesh& mesh) {
  Pseudonormals result{triangle_normals(mesh), vertex_normals(mesh), {}};
  const EdgeConnectivity edges(mesh.F);
  result.edge.resize(mesh.triangle_count());
  for (int h = 0; h < edges.half_edge_count(); ++h) {
    Eigen::Vector3d& normal = result.edge[h / 3][h % 3];
    normal = result.face.row(h / 3);
    if (const int other = edges.twin(h); other >= 0) normal += result.face.row(other / 3);
  }
  return result;
}

/// Nearest point of a triangle and the feature that it lies on: 0 … 2 a corner, 3 … 5 an edge, 6
/// the face. Source: Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
struct NearestPoint {
  Eigen::Vector3d point;
  int feature = 6;
};

NearestPoint nearest_point(const std::array<Eigen::Vector3d, 3>& t, const Eigen::Vector3d& x) {
  const Eigen::Vector3d ab = t[1] - t[0], ac = t[2] - t[0], ax = x - t[0];
  const double d1 = ab.dot(ax), d2 = ac.dot(ax);
  if (d1 <= 0 && d2 <= 0) return {t[0], 0};
  const Eigen::Vector3d bx = x - t[1];
  const double d3 = ab.dot(bx), d4 = ac.dot(bx);
  if (d3 >= 0 && d4 <= d3) return {t[1], 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {t[0] + d1 / (d1 - d3) * ab, 3};
  const Eigen::Vector3d cx = x - t[2];
  const double d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d6 >= 0 && d5 <= d6) return {t[2], 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {t[0] + d2 / (d2 - d6) * ac, 5};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return {t[1] + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (t[2] - t[1]), 4};
  const double sum = va + vb + vc;
  return {t[0] + vb / sum * ab + vc / sum * ac, 6};
}

/// Writes exact signed distances near triangle `t` into the layers [first, last] where they are
/// smaller than what is there.
void stamp_triangle(const TriMesh& mesh, const Pseudonormals& normals, int t, int first, int last,
                    MeshDistance& grid) {
  std::array<Eigen::Vector3d, 3> corner;
  Eigen::AlignedBox3d box;
  for (int c = 0; c < 3; ++c) {
    corner[c] = mesh.V.row(mesh.F(t, c));
    box.extend(corner[c]);
  }
  const Eigen::Array3d low = (box.min() - grid.origin).array() / grid.cell - kBand;
  const Eigen::Array3d high = (box.max() - grid.origin).array() / grid.cell + kBand;
  Eigen::Array3i from = low.ceil().cast<int>().max(0);
  Eigen::Array3i to = high.floor().cast<int>().min(grid.nodes.size.array() - 1);
  from.z() = std::max(from.z(), first);
  to.z() = std::min(to.z(), last);
  for (int k = from.z(); k <= to.z(); ++k)
    for (int j = from.y(); j <= to.y(); ++j)
      for (int i = from.x(); i <= to.x(); ++i) {
        const Eigen::Vector3d x = grid.origin + grid.cell * Eigen::Vector3d(i, j, k);
        const NearestPoint nearest = nearest_point(corner, x);
        const Eigen::Vector3d way = x - nearest.point;
        const auto distance = static_cast<float>(way.norm());
        float& value = grid.nodes(i, j, k);
        if (distance >= std::abs(value)) continue;
        const auto f = nearest.feature;
        const Eigen::Vector3d normal = f < 3   ? Eigen::Vector3d(normals.vertex.row(mesh.F(t, f)))
                                       : f < 6 ? normals.edge[t][f - 3]
                                               : Eigen::Vector3d(normals.face.row(t));
        value = way.dot(normal) >= 0 ? distance : -distance;
      }
}

/// Distance at which the front from three sorted upwind values (m) arrives, first order.
float eikonal_update(std::array<float, 3> upwind, float h) {
  std::sort(upwind.begin(), upwind.end());
  float x = upwind[0] + h;
  if (x > upwind[1]) {
    const float sum = upwind[0] + upwind[1], gap = upwind[0] - upwind[1];
    x = 0.5F * (sum + std::sqrt(std::max(2 * h * h - gap * gap, 0.0F)));
    if (x > upwind[2]) {
      const float s = sum + upwind[2];
      const float q = upwind[0] * upwind[0] + upwind[1] * upwind[1] + upwind[2] * upwind[2];
      x = (s + std::sqrt(std::max(s * s - 3 * (q - h * h), 0.0F))) / 3;
    }
  }
  return x;
}

/// One Gauss–Seidel sweep over nodes that are not exact, in one of eight directions. A node takes
/// the sign of its nearest neighbour.
void sweep(ScalarGrid& d, const std::vector<bool>& exact, int direction, float h) {
  const Eigen::Vector3i n = d.size;
  const auto along = [&](int axis, int s) {
    return ((direction >> axis) & 1) != 0 ? n[axis] - 1 - s : s;
  };
  for (int sk = 0; sk < n.z(); ++sk)
    for (int sj = 0; sj < n.y(); ++sj)
      for (int si = 0; si < n.x(); ++si) {
        const int i = along(0, si), j = along(1, sj), k = along(2, sk);
        const std::size_t at = d.index(i, j, k);
        if (exact[at]) continue;
        const std::array<std::array<float, 2>, 3> around{
            {{i > 0 ? d(i - 1, j, k) : kUnknown, i + 1 < n.x() ? d(i + 1, j, k) : kUnknown},
             {j > 0 ? d(i, j - 1, k) : kUnknown, j + 1 < n.y() ? d(i, j + 1, k) : kUnknown},
             {k > 0 ? d(i, j, k - 1) : kUnknown, k + 1 < n.z() ? d(i, j, k + 1) : kUnknown}}};
        std::array<float, 3> upwind{};
        float nearest = kUnknown;
        for (std::size_t a = 0; a < 3; ++a) {
          const float low = std::abs(around[a][0]), high = std::abs(around[a][1]);
          const float value = low <= high ? around[a][0] : around[a][1];
          upwind[a] = std::min(low, high);
          if (upwind[a] < std::abs(nearest)) nearest = value;
        }
        if (std::abs(nearest) >= kUnknown) continue;
        const float distance = eikonal_update(upwind, h);
        if (distance < std::abs(d.values[at])) d.values[at] = std::copysign(distance, nearest);
      }
}

}  // namespace

MeshDistance mesh_distance(const TriMesh& mesh, double cell) {
  MeshDistance result;
  const Eigen::Vector3d low = mesh.V.colwise().minCoeff(), high = mesh.V.colwise().maxCoeff();
  const Eigen::Array3d room = (high - low).array();
  result.cell = cell;
  while ((room / result.cell + 2 * kMargin + 1).prod() > kMostNodes) result.cell *= 1.1;
  result.origin = low.array() - kMargin * result.cell;
  const Eigen::Vector3i size =
      (room / result.cell).ceil().cast<int>().matrix() + Eigen::Vector3i::Constant(2 * kMargin + 1);
  result.nodes = ScalarGrid(size, kUnknown);
  const Pseudonormals normals = pseudonormals(mesh);
  parallel_blocks(size.z(), 8, [&](std::size_t begin, std::size_t end) {
    for (int t = 0; t < mesh.triangle_count(); ++t)
      stamp_triangle(mesh, normals, t, static_cast<int>(begin), static_cast<int>(end) - 1, result);
  });
  // A stamped value beyond the band may belong to a triangle that is not the nearest one.
  std::vector<bool> exact(result.nodes.values.size());
  for (std::size_t i = 0; i < exact.size(); ++i)
    exact[i] = std::abs(result.nodes.values[i]) <= static_cast<float>(kBand * result.cell);
  for (std::size_t i = 0; i < exact.size(); ++i)
    if (!exact[i]) result.nodes.values[i] = kUnknown;
  for (int pass = 0; pass < 16; ++pass)
    sweep(result.nodes, exact, pass % 8, static_cast<float>(result.cell));
  return result;
}

double MeshDistance::operator()(const Eigen::Vector3d& x) const {
  const Eigen::Array3d last = (nodes.size.array() - 1).cast<double>();
  const Eigen::Array3d wanted = (x - origin).array() / cell;
  const Eigen::Array3d inside = wanted.max(0.0).min(last);
  const Eigen::Array3i base = inside.floor().cast<int>().min(nodes.size.array() - 2);
  const Eigen::Array3d t = inside - base.cast<double>();
  double value = 0;
  for (int c = 0; c < 8; ++c) {
    const int dx = c & 1, dy = (c >> 1) & 1, dz = c >> 2;
    const double w = (dx ? t.x() : 1 - t.x()) * (dy ? t.y() : 1 - t.y()) * (dz ? t.z() : 1 - t.z());
    value += w * static_cast<double>(nodes(base.x() + dx, base.y() + dy, base.z() + dz));
  }
  return value + cell * (wanted - inside).matrix().norm();
}

}  // namespace geoprior::fluid
