#include "solvers/fluid/features/surface_components.h"

#include <Eigen/Geometry>

namespace geoprior::fluid {
namespace {

/// Labels the part that holds `start` and counts its vertices and edges.
void flood(const SurfaceGraph& g, int start, int label, SurfaceComponents& result,
           std::vector<int>& queue) {
  SurfaceComponent& component = result.list.emplace_back();
  queue.assign(1, start);
  result.of_vertex[start] = label;
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const int v = queue[i];
    component.closed = component.closed && g.border[v] == 0;
    for (const int n : g.neighbours(queue[i])) {
      if (result.of_vertex[n] >= 0) continue;
      result.of_vertex[n] = label;
      queue.push_back(n);
    }
  }
  component.vertices = static_cast<int>(queue.size());
}

}  // namespace

SurfaceComponents surface_components(const SurfaceGraph& g) {
  SurfaceComponents result;
  result.of_vertex.assign(g.x.size(), -1);
  std::vector<int> queue, start;
  for (int v = 0; v < g.size(); ++v) {
    if (result.of_vertex[v] >= 0) continue;
    start.push_back(v);
    flood(g, v, static_cast<int>(start.size()) - 1, result, queue);
  }
  // Moments about a point of the component: far from the origin they would cancel.
  for (const auto& t : g.triangle) {
    const int label = result.of_vertex[t[0]];
    SurfaceComponent& component = result.list[label];
    const Eigen::Vector3d& origin = g.x[start[label]];
    const Eigen::Vector3d a = g.x[t[0]] - origin;
    const Eigen::Vector3d b = g.x[t[1]] - origin;
    const Eigen::Vector3d c = g.x[t[2]] - origin;
    const Eigen::Vector3d twice = (b - a).cross(c - a);
    const double volume = a.dot(b.cross(c)) / 6;
    component.area += twice.norm() / 2;
    component.upward += twice.z() / 2;
    component.volume += volume;
    component.centre += volume / 4 * (a + b + c);
  }
  for (std::size_t c = 0; c < result.list.size(); ++c) {
    SurfaceComponent& component = result.list[c];
    if (component.volume != 0) component.centre /= component.volume;
    component.centre += g.x[start[c]];
  }
  return result;
}

}  // namespace geoprior::fluid
