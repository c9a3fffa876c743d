#include "solvers/sketch/pattern/random_cuts.h"

#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

#include "core/geometry/topology.h"
#include "core/random.h"
#include "models/sketch/surface/split.h"

namespace geoprior::sketch {
namespace {

/// The beginning of a path, up to the vertex nearest to where it has the length.
SurfacePath beginning(const SurfacePath& path, const Eigen::MatrixX3d& V, double most) {
  SurfacePath part{path.front()};
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    sum += (path[i].position(V) - path[i - 1].position(V)).norm();
    if (sum > most) {
      part.push_back(at_vertex(path[i].edge[path[i].share > 0.5 ? 1 : 0]));
      return part;
    }
    part.push_back(path[i]);
  }
  return part;
}

/// Vertices of the triangles that a path passes.
std::set<int> vertices_beside(const SurfacePath& path) {
  std::set<int> beside;
  for (const EdgePoint& point : path) beside.insert(point.edge.begin(), point.edge.end());
  return beside;
}

}  // namespace

std::vector<SurfacePath> random_cuts(const TriMesh& piece, double length_asked, int seed) {
  constexpr int kDraws = 200;
  RandomStream random(static_cast<std::uint64_t>(seed), "random cuts");
  std::vector<int> border;
  for (const Edge& e : boundary_edges(piece.F)) border.push_back(e[0]);
  std::vector<SurfacePath> cuts;
  if (border.empty()) return cuts;
  const SurfacePaths paths(piece, Eigen::VectorXd::Ones(piece.triangle_count()));
  std::set<int> taken;
  double left = length_asked;
  for (int draw = 0; draw < kDraws && left > 0.02 * length_asked; ++draw) {
    const int from = border[random.below(static_cast<std::uint32_t>(border.size()))];
    const auto to = random.below(static_cast<std::uint32_t>(piece.vertex_count()));
    std::vector<char> targets(piece.vertex_count(), 0);
    targets[to] = 1;
    const SurfacePath whole = paths.shortest(from, targets);
    if (whole.size() < 2) continue;
    SurfacePath path = beginning(whole, piece.V, left);
    const std::set<int> beside = vertices_beside(path);
    bool apart = true;
    for (const int v : beside) apart = apart && !taken.contains(v);
    std::vector<SurfacePath> with = cuts;
    with.push_back(path);
    if (!apart || !split_along(piece, with)) continue;
    left -= length(path, piece.V);
    taken.insert(beside.begin(), beside.end());
    cuts.push_back(std::move(path));
  }
  return cuts;
}

}  // namespace geoprior::sketch
