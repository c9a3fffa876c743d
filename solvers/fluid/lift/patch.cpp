#include "solvers/fluid/lift/patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

#include "solvers/fluid/features/base_surface.h"
#include "solvers/fluid/features/surface_graph.h"

namespace geoprior::fluid {
namespace {

constexpr double kUnreached = std::numeric_limits<double>::infinity();

Eigen::Vector3d row(const Eigen::MatrixX3d& V, int v) { return V.row(v).transpose(); }

bool touches(const TriMesh& mesh, Eigen::Index t, const std::vector<double>& distance) {
  for (int k = 0; k < 3; ++k) {
    if (distance[mesh.F(t, k)] < kUnreached) return true;
  }
  return false;
}

/// Centre, normal, covariance and area of the bed under the region itself.
FrameSample bed_sample(const TriMesh& mesh, const Eigen::MatrixX3d& bed,
                       const std::vector<int>& label, int wanted) {
  FrameSample sample;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero(), first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    int inside = 0;
    for (int k = 0; k < 3; ++k) {
      inside += label[mesh.F(t, k)] == wanted ? 1 : 0;
    }
    if (inside == 0) continue;
    if (sample.area == 0) origin = row(bed, mesh.F(t, 0));
    const Eigen::Vector3d a = row(bed, mesh.F(t, 0)) - origin, b = row(bed, mesh.F(t, 1)) - origin,
                          c = row(bed, mesh.F(t, 2)) - origin;
    const Eigen::Vector3d n = (b - a).cross(c - a);
    const double share = 0.5 * n.norm() * inside / 3;
    const Eigen::Vector3d middle = (a + b + c) / 3;
    normal += inside * n;
    first += share * middle;
    second += share * middle * middle.transpose();
    sample.area += share;
  }
  if (sample.area > 0) {
    const Eigen::Vector3d mean = first / sample.area;
    sample.centre = origin + mean;
    sample.covariance = second / sample.area - mean * mean.transpose();
    sample.normal = normal.normalized();
  }
  return sample;
}

}  // namespace

std::vector<double> distance_from_region(const TriMesh& mesh, const FrameLabels& labels,
                                         const std::vector<int>& wanted, double reach) {
  const SurfaceGraph graph = surface_graph(mesh);
  std::vector<double> distance(graph.size(), kUnreached);
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (int v = 0; v < graph.size(); ++v) {
    const int label = labels.label[v];
    if (label == 0 || std::find(wanted.begin(), wanted.end(), label) == wanted.end()) continue;
    distance[v] = 0;
    queue.emplace(0.0, v);
  }
  while (!queue.empty()) {
    const auto [d, v] = queue.top();
    queue.pop();
    if (d > distance[v]) continue;
    for (const int w : graph.neighbours(v)) {
      if (!labels.masked.empty() && labels.masked[w] != 0) continue;
      const double further = d + (graph.x[w] - graph.x[v]).norm();
      if (further >= distance[w] || further > reach) continue;
      distance[w] = further;
      queue.emplace(further, w);
    }
  }
  return distance;
}

LiftPatch lift_patch(const SurfaceFrame& frame, const FrameLabels& labels, const Region& region,
                     double border) {
  const TriMesh& mesh = frame.mesh;
  const std::vector<double> distance = distance_from_region(mesh, labels, {region.label}, border);
  std::vector<char> inside(distance.size());
  for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = distance[v] < kUnreached ? 1 : 0;
  const Eigen::MatrixX3d bed = unfolded_base(mesh, inside);
  LiftPatch patch;
  patch.sample = bed_sample(mesh, bed, labels.label, region.label);
  patch.sample.frame = region.frame;
  patch.sample.time = frame.time;
  std::vector<int> local(distance.size(), -1);
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    if (!touches(mesh, t, distance)) continue;
    std::array<int, 3> triangle{};
    for (int k = 0; k < 3; ++k) {
      const int v = mesh.F(t, k);
      int& id = local[v];
      if (id < 0) {
        id = static_cast<int>(patch.surface.size());
        patch.surface.push_back((row(mesh.V, v) - patch.sample.centre).cast<float>());
        patch.bed.push_back((row(bed, v) - patch.sample.centre).cast<float>());
        patch.distance.push_back(static_cast<float>(std::min(distance[v], border)));
      }
      triangle[k] = id;
    }
    patch.triangles.push_back(triangle);
  }
  return patch;
}

TriMesh isolated_mesh(const TriMesh& mesh, const FrameLabels& labels, int label) {
  TriMesh result;
  std::vector<int> local(labels.label.size(), -1);
  int count = 0;
  for (std::size_t v = 0; v < local.size(); ++v) {
    if (labels.label[v] == label) local[v] = count++;
  }
  result.V.resize(count, 3);
  for (std::size_t v = 0; v < local.size(); ++v) {
    if (local[v] >= 0) result.V.row(local[v]) = mesh.V.row(v);
  }
  std::vector<Eigen::Index> kept;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    if (local[mesh.F(t, 0)] >= 0 && local[mesh.F(t, 1)] >= 0 && local[mesh.F(t, 2)] >= 0) {
      kept.push_back(t);
    }
  }
  result.F.resize(kept.size(), 3);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      result.F(i, k) = local[mesh.F(kept[i], k)];
    }
  }
  return result;
}

}  // namespace geoprior::fluid
