#include "models/sketch/surface/cut_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "core/disjoint_sets.h"
#include "core/error.h"

namespace geoprior::sketch {
namespace {

constexpr int kNoSeam = -1;

std::string seam_edge_text(const Edge& edge) {
  return "edge " + std::to_string(edge[0]) + " " + std::to_string(edge[1]);
}

/// A surface, the seam of every edge, and which half-edges lie at a border once it is cut.
class MarkedSurface {
 public:
  MarkedSurface(const TriMesh& surface, std::span<const SeamEdge> seams)
      : edges(surface.F), seam_(edges.edge_count(), kNoSeam) {
    if (const auto repeated = edges.first_repeated()) {
      throw Error("no consistently oriented manifold",
                  seam_edge_text(edges.edge(edges.edge_of(*repeated))),
                  "two triangles in which it runs opposite ways, or one");
    }
    for (const SeamEdge& cut : seams) {
      const auto e = edges.find(cut.edge[0], cut.edge[1]);
      if (!e)
        throw Error("a seam follows what is no edge of the surface", seam_edge_text(cut.edge));
      if (cut.seam < 0) throw Error("seam is negative", seam_edge_text(cut.edge), "0 and above");
      if (edges.half_edges(*e).size() == 2 && seam_[*e] == kNoSeam) seam_[*e] = cut.seam;
    }
  }

  EdgeConnectivity edges;

  [[nodiscard]] int seam(int half_edge) const { return seam_[edges.edge_of(half_edge)]; }
  [[nodiscard]] bool open(int half_edge) const {
    return edges.twin(half_edge) < 0 || seam(half_edge) != kNoSeam;
  }

 private:
  std::vector<int> seam_;
};

/// Vertices of the surface at which stretches of borders end: where other than two open edges meet,
/// or two of different seams.
std::vector<bool> seam_ends(const MarkedSurface& marked, int vertex_count) {
  constexpr int kNone = -2;
  std::vector<int> count(vertex_count, 0), first(vertex_count, kNone);
  std::vector<bool> end(vertex_count, false);
  for (int e = 0; e < marked.edges.edge_count(); ++e) {
    const int half_edge = marked.edges.half_edges(e)[0];
    if (!marked.open(half_edge)) continue;
    for (const int v : marked.edges.edge(e)) {
      if (first[v] == kNone) first[v] = marked.seam(half_edge);
      ++count[v];
      if (first[v] != marked.seam(half_edge)) end[v] = true;
    }
  }
  for (int v = 0; v < vertex_count; ++v) end[v] = end[v] || (count[v] != 0 && count[v] != 2);
  return end;
}

/// The corners that are one vertex once the surface is cut, and the triangles that are one piece.
struct GluedParts {
  DisjointSets corners, triangles;
};

GluedParts glue_corners(const MarkedSurface& marked) {
  const int half_edges = marked.edges.half_edge_count();
  GluedParts parts{DisjointSets(half_edges), DisjointSets(half_edges / 3)};
  for (int h = 0; h < half_edges; ++h) {
    if (marked.open(h) || marked.edges.twin(h) < h) continue;
    const int twin = marked.edges.twin(h);
    parts.corners.join(h, EdgeConnectivity::next(twin));
    parts.corners.join(EdgeConnectivity::next(h), twin);
    parts.triangles.join(h / 3, twin / 3);
  }
  return parts;
}

/// Cuts; keeps of every corner its vertex in its piece and of every open half-edge its stretch.
class SurfaceCutter {
 public:
  SurfaceCutter(const TriMesh& surface, std::span<const SeamEdge> seams)
      : surface_(surface),
        marked_(surface, seams),
        end_(seam_ends(marked_, surface.vertex_count())),
        vertex_of_corner_(marked_.edges.half_edge_count(), -1),
        stretch_(marked_.edges.half_edge_count()) {}

  std::vector<CutPiece> cut() {
    separate();
    for (int p = 0; p < std::ssize(pieces_); ++p) trace_borders(p);
    for (CutPiece& piece : pieces_) pair_up(piece);
    return std::move(pieces_);
  }

 private:
  /// Place of a half-edge in the `edges` of a piece.
  struct Stretch {
    int piece = -1, edge = -1;
  };

  void separate();
  void trace_borders(int p);
  [[nodiscard]] std::vector<std::vector<int>> border_loops(const CutPiece& piece) const;
  void cut_loop(int p, const std::vector<int>& loop);
  void pair_up(CutPiece& piece);
  [[nodiscard]] int start_of(const std::vector<int>& loop) const;

  const TriMesh& surface_;
  MarkedSurface marked_;
  std::vector<bool> end_;
  std::vector<int> vertex_of_corner_;
  std::vector<Stretch> stretch_;
  std::vector<std::vector<int>> first_half_edge_;  ///< of each stretch of each piece
  std::vector<CutPiece> pieces_;
};

void SurfaceCutter::separate() {
  GluedParts parts = glue_corners(marked_);
  std::vector<int> piece_of_root(surface_.triangle_count(), -1);
  for (int t = 0; t < surface_.triangle_count(); ++t) {
    int& piece = piece_of_root[parts.triangles.find(t)];
    if (piece < 0) {
      piece = static_cast<int>(pieces_.size());
      pieces_.emplace_back();
    }
    pieces_[piece].surface_triangle.push_back(t);
  }
  std::vector<int> vertex_of_root(vertex_of_corner_.size(), -1);
  for (CutPiece& piece : pieces_) {
    for (const int t : piece.surface_triangle) {
      for (int c = 3 * t; c < 3 * t + 3; ++c) {
        int& vertex = vertex_of_root[parts.corners.find(c)];
        if (vertex < 0) {
          vertex = static_cast<int>(piece.surface_vertex.size());
          piece.surface_vertex.push_back(marked_.edges.origin(c));
        }
        vertex_of_corner_[c] = vertex;
      }
    }
    piece.mesh.V = surface_.V(piece.surface_vertex, Eigen::all);
    piece.mesh.F.resize(piece.surface_triangle.size(), 3);
    for (Eigen::Index i = 0; i < piece.mesh.F.rows(); ++i) {
      const int c = 3 * piece.surface_triangle[i];
      piece.mesh.F.row(i) << vertex_of_corner_[c], vertex_of_corner_[c + 1],
          vertex_of_corner_[c + 2];
    }
  }
  first_half_edge_.resize(pieces_.size());
}

/// Every vertex of a piece is one fan of triangles, so that at most one border leaves it.
std::vector<std::vector<int>> SurfaceCutter::border_loops(const CutPiece& piece) const {
  std::vector<int> leaving(piece.surface_vertex.size(), -1);
  for (const int t : piece.surface_triangle) {
    for (int h = 3 * t; h < 3 * t + 3; ++h) {
      if (marked_.open(h)) leaving[vertex_of_corner_[h]] = h;
    }
  }
  std::vector<std::vector<int>> loops;
  for (int v = 0; v < std::ssize(leaving); ++v) {
    if (leaving[v] < 0) continue;
    std::vector<int>& loop = loops.emplace_back();
    for (int at = v; leaving[at] >= 0;) {
      const int h = std::exchange(leaving[at], -1);
      loop.push_back(h);
      at = vertex_of_corner_[EdgeConnectivity::next(h)];
    }
  }
  return loops;
}

void SurfaceCutter::trace_borders(int p) {
  CutPiece& piece = pieces_[p];
  std::vector<std::vector<int>> loops = border_loops(piece);
  std::vector<double> length(loops.size(), 0.0);
  int border_edges = 0;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    border_edges += static_cast<int>(loops[i].size());
    for (const int h : loops[i])
      length[i] +=
          (surface_.V.row(marked_.edges.tip(h)) - surface_.V.row(marked_.edges.origin(h))).norm();
  }
  std::vector<std::size_t> order(loops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return length[i] > length[j]; });
  for (const std::size_t i : order) {
    std::vector<int>& border = piece.borders.emplace_back();
    for (const int h : loops[i]) border.push_back(vertex_of_corner_[h]);
    cut_loop(p, loops[i]);
  }
  const int edge_count = (3 * piece.mesh.triangle_count() + border_edges) / 2;
  piece.euler_characteristic = piece.mesh.vertex_count() - edge_count + piece.mesh.triangle_count();
}

/// Index in a loop at which a stretch begins: the first end of a seam, or where there is none the
/// vertex lowest in the surface, which both sides of a closed seam agree on.
int SurfaceCutter::start_of(const std::vector<int>& loop) const {
  std::size_t lowest = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (end_[marked_.edges.origin(loop[i])]) return static_cast<int>(i);
    if (marked_.edges.origin(loop[i]) < marked_.edges.origin(loop[lowest])) lowest = i;
  }
  return static_cast<int>(lowest);
}

void SurfaceCutter::cut_loop(int p, const std::vector<int>& loop) {
  std::vector<PieceEdge>& edges = pieces_[p].edges;
  const int start = start_of(loop);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const int h = loop[(start + i) % loop.size()];
    if (i == 0 || end_[marked_.edges.origin(h)]) {
      edges.emplace_back().vertices.push_back(vertex_of_corner_[h]);
      edges.back().seam = marked_.seam(h);
      first_half_edge_[p].push_back(h);
    }
    edges.back().vertices.push_back(vertex_of_corner_[EdgeConnectivity::next(h)]);
    stretch_[h] = {p, static_cast<int>(edges.size()) - 1};
  }
}

void SurfaceCutter::pair_up(CutPiece& piece) {
  const std::size_t p = &piece - pieces_.data();
  for (std::size_t i = 0; i < piece.edges.size(); ++i) {
    if (piece.edges[i].seam == kNoSeam) continue;
    const Stretch other = stretch_[marked_.edges.twin(first_half_edge_[p][i])];
    piece.edges[i].partner_piece = other.piece;
    piece.edges[i].partner_edge = other.edge;
  }
}

}  // namespace

std::vector<CutPiece> cut_surface(const TriMesh& surface, std::span<const SeamEdge> seams) {
  return SurfaceCutter(surface, seams).cut();
}

std::vector<double> border_turnings(const CutPiece& piece) {
  std::vector<double> angle(piece.surface_vertex.size(), 0.0);
  const TriMesh& mesh = piece.mesh;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d at = mesh.V.row(mesh.F(t, k)).transpose();
      const Eigen::Vector3d next = mesh.V.row(mesh.F(t, (k + 1) % 3)).transpose() - at;
      const Eigen::Vector3d last = mesh.V.row(mesh.F(t, (k + 2) % 3)).transpose() - at;
      angle[mesh.F(t, k)] += std::atan2(next.cross(last).norm(), next.dot(last));
    }
  }
  std::vector<double> turnings;
  for (const std::vector<int>& border : piece.borders) {
    double& turning = turnings.emplace_back(0.0);
    for (const int v : border) turning += std::numbers::pi - angle[v];
  }
  return turnings;
}

}  // namespace geoprior::sketch
