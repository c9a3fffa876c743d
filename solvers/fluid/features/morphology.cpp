#include "solvers/fluid/features/morphology.h"

#include <algorithm>
#include <limits>

#include "solvers/fluid/features/regions.h"

namespace geoprior::fluid {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

}  // namespace

Morphology::Morphology(const SurfaceGraph& graph, const std::vector<char>& active)
    : graph_(graph), active_(active), distance_(graph.x.size(), kFar) {}

/// Gives the value `from` to the active vertices within `radius` of those that have it.
void Morphology::spread(std::vector<char>& set, char from, double radius) {
  const auto later = [](const Reached& a, const Reached& b) { return a.distance > b.distance; };
  heap_.clear();
  touched_.clear();
  const auto relax = [&](int v, double base) {
    const Eigen::Vector3d& x = graph_.x[v];
    for (const int n : graph_.neighbours(v)) {
      if (active_[n] == 0 || set[n] == from) continue;
      const double d = base + (graph_.x[n] - x).norm();
      if (d > radius || d >= distance_[n]) continue;
      if (distance_[n] == kFar) touched_.push_back(n);
      distance_[n] = d;
      heap_.push_back({d, n});
      std::push_heap(heap_.begin(), heap_.end(), later);
    }
  };
  for (int v = 0; v < std::ssize(set); ++v) {
    if (active_[v] != 0 && set[v] == from) relax(v, 0);
  }
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const Reached r = heap_.back();
    heap_.pop_back();
    if (r.distance == distance_[r.vertex]) relax(r.vertex, r.distance);
  }
  for (const int v : touched_) {
    set[v] = from;
    distance_[v] = kFar;
  }
}

void Morphology::dilate(std::vector<char>& set, double radius) { spread(set, 1, radius); }

void Morphology::erode(std::vector<char>& set, double radius) { spread(set, 0, radius); }

void Morphology::fill_holes(std::vector<char>& set, const std::vector<double>& area,
                            double largest) {
  std::vector<char> seen(set.size(), 0);
  std::vector<int> part;
  for (int s = 0; s < std::ssize(set); ++s) {
    if (seen[s] != 0 || set[s] != 0 || active_[s] == 0) continue;
    part.assign(1, s);
    seen[s] = 1;
    double total = 0;
    bool surrounded = true, touches = false;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const int v = part[i];
      total += area[v];
      surrounded = surrounded && graph_.border[v] == 0;
      for (const int n : graph_.neighbours(part[i])) {
        surrounded = surrounded && active_[n] != 0;
        touches = touches || set[n] != 0;
        if (active_[n] == 0 || set[n] != 0 || seen[n] != 0) continue;
        seen[n] = 1;
        part.push_back(n);
      }
    }
    if (!surrounded || !touches || total > largest) continue;
    for (const int v : part) set[v] = 1;
  }
}

std::vector<char> dilate(const TriMesh& mesh, const std::vector<char>& set, double radius) {
  const SurfaceGraph graph = surface_graph(mesh);
  const std::vector<char> active(set.size(), 1);
  std::vector<char> result = set;
  Morphology(graph, active).dilate(result, radius);
  return result;
}

std::vector<char> erode(const TriMesh& mesh, const std::vector<char>& set, double radius) {
  const SurfaceGraph graph = surface_graph(mesh);
  const std::vector<char> active(set.size(), 1);
  std::vector<char> result = set;
  Morphology(graph, active).erode(result, radius);
  return result;
}

}  // namespace geoprior::fluid
