#include "core/geometry/subdivision.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/topology.h"

namespace geoprior {
namespace {

using Triplet = Eigen::Triplet<double>;

/// An undirected edge with its (at most two) triangles and the vertices opposite to it.
struct EdgeInfo {
  int a = -1;
  int b = -1;
  std::array<int, 2> triangle{-1, -1};
  std::array<int, 2> opposite{-1, -1};
  int midpoint = -1;  ///< index of the new vertex, -1 when the edge is kept
};

/// Edges of a mesh; `of[t][k]` is the edge from corner k of triangle t to the next one.
struct EdgeTable {
  std::vector<EdgeInfo> edges;
  std::vector<std::array<int, 3>> of;
};

/// Edges in the order in which triangles first have them.
EdgeTable edge_table(const Eigen::MatrixX3i& F) {
  const EdgeConnectivity connectivity(F);
  if (const auto h = connectivity.first_repeated()) {
    throw Error("subdivision needs a manifold mesh of consistent orientation",
                "edge " + std::to_string(connectivity.origin(*h)) + "-" +
                    std::to_string(connectivity.tip(*h)),
                "two triangles of opposite direction at every edge");
  }
  EdgeTable table;
  table.edges.reserve(connectivity.edge_count());
  table.of.resize(F.rows());
  for (int h = 0; h < connectivity.half_edge_count(); ++h) {
    const int first = connectivity.half_edges(connectivity.edge_of(h))[0];
    int& index = table.of[h / 3][h % 3];
    if (first == h) {
      index = static_cast<int>(table.edges.size());
      table.edges.push_back({connectivity.origin(h), connectivity.tip(h)});
    } else {
      index = table.of[first / 3][first % 3];
    }
    EdgeInfo& edge = table.edges[index];
    const int side = first == h ? 0 : 1;
    edge.triangle[side] = h / 3;
    edge.opposite[side] = F(h / 3, (h % 3 + 2) % 3);
  }
  return table;
}

/// Triangles to split in four: the marked ones, and by closure those that would have two or three
/// split edges.
std::vector<bool> quartered_triangles(const EdgeTable& table, std::vector<bool> quartered) {
  std::vector<int> split_edges(table.of.size(), 0);
  std::vector<bool> edge_is_split(table.edges.size(), false);
  std::vector<int> stack;
  for (int t = 0; t < std::ssize(quartered); ++t) {
    if (quartered[t]) stack.push_back(t);
  }
  while (!stack.empty()) {
    const std::size_t t = stack.back();
    stack.pop_back();
    for (const int e : table.of[t]) {
      const std::size_t edge = e;
      if (edge_is_split[edge]) continue;
      edge_is_split[edge] = true;
      for (const int side : table.edges[edge].triangle) {
        if (side < 0) continue;
        if (++split_edges[side] >= 2 && !quartered[side]) {
          quartered[side] = true;
          stack.push_back(side);
        }
      }
    }
  }
  return quartered;
}

/// Triangles of the refined mesh.
void split_triangles(const Eigen::MatrixX3i& F, const EdgeTable& table,
                     const std::vector<bool>& quartered, Subdivision& result) {
  std::vector<Eigen::RowVector3i> rows;
  const auto add = [&](int parent, int a, int b, int c) {
    rows.emplace_back(a, b, c);
    result.parent.push_back(parent);
    result.quartered.push_back(quartered[parent]);
  };
  for (int t = 0; t < F.rows(); ++t) {
    std::array<int, 3> mid{};
    for (std::size_t k = 0; k < 3; ++k) {
      const int e = table.of[t][k];
      mid[k] = table.edges[e].midpoint;
    }
    const int a = F(t, 0), b = F(t, 1), c = F(t, 2);
    if (quartered[t]) {
      add(t, a, mid[0], mid[2]);
      add(t, mid[0], b, mid[1]);
      add(t, mid[2], mid[1], c);
      add(t, mid[0], mid[1], mid[2]);
    } else if (mid[0] >= 0) {
      add(t, a, mid[0], c);
      add(t, mid[0], b, c);
    } else if (mid[1] >= 0) {
      add(t, b, mid[1], a);
      add(t, mid[1], c, a);
    } else if (mid[2] >= 0) {
      add(t, c, mid[2], b);
      add(t, mid[2], a, b);
    } else {
      add(t, a, b, c);
    }
  }
  result.F.resize(rows.size(), 3);
  for (std::size_t i = 0; i < rows.size(); ++i) result.F.row(i) = rows[i];
}

/// Rows of old vertices: smoothed where every triangle around is quartered, else kept.
void old_vertex_rows(const Eigen::MatrixX3i& F, int vertex_count,
                     const std::vector<bool>& quartered, std::vector<Triplet>& entries) {
  std::vector<bool> moves(vertex_count, true);
  std::vector<int> triangles(vertex_count, 0);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::size_t v = F(t, k);
      ++triangles[v];
      if (!quartered[t]) moves[v] = false;
    }
  }
  const VertexGraph rings = one_rings(F, vertex_count);
  for (int v = 0; v < vertex_count; ++v) {
    const std::span<const int> ring = rings.of(v);
    const auto n = static_cast<int>(ring.size());
    const int count = triangles[v];
    if (!moves[v] || n < 2 || count < n - 1) {
      entries.emplace_back(v, v, 1.0);  // outside the region, or where several borders meet
    } else if (count < n) {
      // The ring of a border vertex starts and ends on the border.
      entries.emplace_back(v, v, 0.75);
      entries.emplace_back(v, ring.front(), 0.125);
      entries.emplace_back(v, ring.back(), 0.125);
    } else {
      const double c = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n);
      const double all_neighbours = 0.625 - c * c;
      entries.emplace_back(v, v, 1 - all_neighbours);
      for (const int u : ring) entries.emplace_back(v, u, all_neighbours / n);
    }
  }
}

void new_vertex_row(const EdgeInfo& edge, const std::vector<bool>& quartered,
                    std::vector<Triplet>& entries) {
  const bool smooth =
      edge.triangle[1] >= 0 && quartered[edge.triangle[0]] && quartered[edge.triangle[1]];
  entries.emplace_back(edge.midpoint, edge.a, smooth ? 0.375 : 0.5);
  entries.emplace_back(edge.midpoint, edge.b, smooth ? 0.375 : 0.5);
  if (!smooth) return;
  entries.emplace_back(edge.midpoint, edge.opposite[0], 0.125);
  entries.emplace_back(edge.midpoint, edge.opposite[1], 0.125);
}

/// The region and every triangle that shares a vertex with it.
std::vector<bool> grown(const Eigen::MatrixX3i& F, int vertex_count,
                        const std::vector<bool>& region) {
  std::vector<bool> touched(vertex_count, false);
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (int k = 0; k < 3 && region[t]; ++k) touched[F(t, k)] = true;
  }
  std::vector<bool> result = region;
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) {
      if (touched[F(t, k)]) result[t] = true;
    }
  }
  return result;
}

RiggedMesh apply(const RiggedMesh& rig, const Subdivision& step) {
  RiggedMesh result;
  result.mesh.V = step.stencil * rig.mesh.V;
  result.mesh.F = step.F;
  result.skeleton = rig.skeleton;
  if (rig.weights.size() > 0) result.weights = step.stencil * rig.weights;
  return result;
}

}  // namespace

Subdivision loop_subdivision(const Eigen::MatrixX3i& F, int vertex_count,
                             const std::vector<bool>& refine) {
  const std::size_t triangles = F.rows();
  if (!refine.empty() && refine.size() != triangles) {
    throw Error(std::to_string(refine.size()) + " marks for the triangles to subdivide", "",
                std::to_string(triangles));
  }
  EdgeTable table = edge_table(F);
  const std::vector<bool> quartered =
      quartered_triangles(table, refine.empty() ? std::vector<bool>(triangles, true) : refine);

  Subdivision result;
  std::vector<Triplet> entries;
  old_vertex_rows(F, vertex_count, quartered, entries);
  for (EdgeInfo& edge : table.edges) {
    const bool split = std::any_of(edge.triangle.begin(), edge.triangle.end(),
                                   [&](int t) { return t >= 0 && quartered[t]; });
    if (!split) continue;
    edge.midpoint = vertex_count + static_cast<int>(result.split_edge.size());
    result.split_edge.push_back({edge.a, edge.b});
    new_vertex_row(edge, quartered, entries);
  }
  result.stencil.resize(vertex_count + static_cast<int>(result.split_edge.size()), vertex_count);
  result.stencil.setFromTriplets(entries.begin(), entries.end());
  split_triangles(F, table, quartered, result);
  return result;
}

RiggedMesh loop_subdivide(const RiggedMesh& rig, const std::vector<bool>& refine) {
  return apply(rig, loop_subdivision(rig.mesh.F, rig.mesh.vertex_count(), refine));
}

RefinedRig loop_subdivide_region(const RiggedMesh& rig, const std::vector<bool>& region,
                                 int steps) {
  RefinedRig result;
  result.rig = rig;
  std::vector<bool> wanted =
      region.empty() ? std::vector<bool>(rig.mesh.triangle_count(), true) : region;
  for (int step = 0; step < steps; ++step) {
    const TriMesh& mesh = result.rig.mesh;
    std::vector<bool> refine = wanted;
    for (int ring = step + 1; ring < steps; ++ring)
      refine = grown(mesh.F, mesh.vertex_count(), refine);
    Subdivision made = loop_subdivision(mesh.F, mesh.vertex_count(), refine);
    std::vector<bool> inherited;
    for (const int parent : made.parent) inherited.push_back(wanted[parent]);
    result.rig = apply(result.rig, made);
    wanted = std::move(inherited);
    result.steps.push_back(std::move(made));
  }
  return result;
}

SplitSubdivision subdivide_split(const TriMesh& split, const std::vector<int>& welded_of_split,
                                 const Eigen::MatrixX3i& welded_triangles, const Subdivision& step,
                                 const Eigen::MatrixX3d& welded_positions) {
  const auto welded = [&](int v) { return welded_of_split[v]; };
  for (Eigen::Index t = 0; t < std::max(split.F.rows(), welded_triangles.rows()); ++t) {
    bool same = t < split.F.rows() && t < welded_triangles.rows();
    for (int k = 0; same && k < 3; ++k) same = welded(split.F(t, k)) == welded_triangles(t, k);
    if (!same) throw Error("split and welded mesh differ", "triangle " + std::to_string(t));
  }
  SplitSubdivision result;
  result.welded_of_split = welded_of_split;
  const auto old_count = static_cast<int>(step.stencil.cols());
  const EdgeConnectivity edges(split.F);
  std::vector<int> midpoint(edges.edge_count(), -1);
  // A corner of a new triangle, in the split vertices of its parent.
  const auto split_vertex = [&](int parent, int corner) {
    const auto of_welded = [&](int w) {
      for (int k = 0; k < 2; ++k) {
        if (welded_triangles(parent, k) == w) return split.F(parent, k);
      }
      return split.F(parent, 2);
    };
    if (corner < old_count) return of_welded(corner);
    const auto& edge = step.split_edge[corner - old_count];
    const int a = of_welded(edge[0]), b = of_welded(edge[1]);
    int& vertex = midpoint[edges.find(a, b).value()];
    if (vertex < 0) {
      vertex = static_cast<int>(result.welded_of_split.size());
      result.welded_of_split.push_back(corner);
      result.split_edge.push_back({a, b});
    }
    return vertex;
  };
  result.mesh.F.resize(step.F.rows(), 3);
  for (Eigen::Index t = 0; t < step.F.rows(); ++t) {
    for (int k = 0; k < 3; ++k) result.mesh.F(t, k) = split_vertex(step.parent[t], step.F(t, k));
  }
  result.mesh.V.resize(result.welded_of_split.size(), 3);
  for (Eigen::Index v = 0; v < result.mesh.V.rows(); ++v)
    result.mesh.V.row(v) = welded_positions.row(result.welded_of_split[v]);
  return result;
}

}  // namespace geoprior
