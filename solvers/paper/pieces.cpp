#include "solvers/paper/pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/connectivity.h"
#include "core/disjoint_sets.h"
#include "core/planar.h"
#include "solvers/paper/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Rulings on the outline of each cell, each once, sorted.
std::vector<std::vector<int>> rulings_of_cells(const RulingMesh& mesh,
                                               const EdgeConnectivity& edges) {
  std::vector<std::vector<int>> result(mesh.cell_count);
  for (std::size_t r = 0; r < mesh.ruling_paths.size(); ++r) {
    const std::vector<int>& path = mesh.ruling_paths[r];
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      const auto e = edges.find(path[k], path[k + 1]);
      if (!e) continue;
      for (const int f : {edges.left(*e), edges.right(*e)}) {
        if (f < 0) continue;
        auto& list = result[mesh.cell[f]];
        if (list.empty() || list.back() != static_cast<int>(r)) list.push_back(static_cast<int>(r));
      }
    }
  }
  for (auto& list : result) list.erase(std::unique(list.begin(), list.end()), list.end());
  return result;
}

bool is_chord(const Ruling& r) { return !r.singular_a && !r.singular_b; }

std::optional<int> common_apex(const Ruling& r, const Ruling& s) {
  for (const auto& p : {r.singular_a, r.singular_b}) {
    if (p && (p == s.singular_a || p == s.singular_b)) return p;
  }
  return std::nullopt;
}

/// The kind that a cell between these rulings has, and the apex of a cone.
std::pair<PaperPiece::Kind, std::optional<int>> kind_of_cell(const PaperStructure& structure,
                                                             const std::vector<int>& rulings) {
  if (rulings.size() != 2) return {PaperPiece::Kind::flat, std::nullopt};
  const Ruling& r = structure.rulings[rulings[0]];
  const Ruling& s = structure.rulings[rulings[1]];
  if (const auto apex = common_apex(r, s)) return {PaperPiece::Kind::cone, apex};
  const double angle = line_angle(r.b - r.a, s.b - s.a) * 180 / std::numbers::pi;
  if (is_chord(r) && is_chord(s) && angle <= kParallelDegrees) {
    return {PaperPiece::Kind::cylinder, std::nullopt};
  }
  return {PaperPiece::Kind::flat, std::nullopt};
}

void sort_cylinder(const PaperStructure& structure, PaperPiece& piece) {
  Vector2d sum = Vector2d::Zero();
  const Ruling& first = structure.rulings[piece.rulings.front()];
  for (const int i : piece.rulings) {
    const Ruling& r = structure.rulings[i];
    const Vector2d d = r.b - r.a;
    sum += d.dot(first.b - first.a) < 0 ? Vector2d(-d) : d;
  }
  piece.direction = sum.normalized();
  const auto offset = [&](int i) {
    const Ruling& r = structure.rulings[i];
    return cross(piece.direction, r.a + r.b);
  };
  std::sort(piece.rulings.begin(), piece.rulings.end(),
            [&](int i, int j) { return offset(i) < offset(j); });
}

/// Counter-clockwise about the apex, beginning behind the widest gap.
void sort_cone(const PaperStructure& structure, int apex, PaperPiece& piece) {
  const Vector2d p = structure.singular_points[apex].position;
  std::vector<std::pair<double, int>> angles;
  for (const int i : piece.rulings) {
    const Ruling& r = structure.rulings[i];
    const Vector2d d = (r.singular_a == apex ? r.b : r.a) - p;
    angles.emplace_back(std::atan2(d.y(), d.x()), i);
  }
  std::sort(angles.begin(), angles.end());
  std::size_t first = 0;
  double widest = angles.front().first + 2 * std::numbers::pi - angles.back().first;
  for (std::size_t k = 1; k < angles.size(); ++k) {
    const double gap = angles[k].first - angles[k - 1].first;
    if (gap > widest) {
      widest = gap;
      first = k;
    }
  }
  std::rotate(angles.begin(), angles.begin() + static_cast<std::ptrdiff_t>(first), angles.end());
  for (std::size_t k = 0; k < angles.size(); ++k) piece.rulings[k] = angles[k].second;
  piece.apex = p;
  piece.singular_point = apex;
}

/// Ids of the pieces that the rulings were in before; the largest share decides.
void inherit_ids(const PaperStructure& before, std::vector<PaperPiece>& pieces, int& next_id) {
  struct Vote {
    int count, piece, id;
  };
  std::vector<Vote> votes;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].id = -1;
    std::map<int, int> counts;
    for (const int r : pieces[i].rulings) {
      const int old = before.rulings[r].piece;
      if (old >= 0 && old < static_cast<int>(before.pieces.size()) &&
          before.pieces[old].kind == pieces[i].kind) {
        ++counts[before.pieces[old].id];
      }
    }
    for (const auto& [id, count] : counts) votes.push_back({count, static_cast<int>(i), id});
  }
  std::stable_sort(votes.begin(), votes.end(),
                   [](const Vote& x, const Vote& y) { return x.count > y.count; });
  std::vector<int> taken;
  for (const Vote& vote : votes) {
    int& id = pieces[vote.piece].id;
    if (id >= 0 || std::find(taken.begin(), taken.end(), vote.id) != taken.end()) continue;
    id = vote.id;
    taken.push_back(vote.id);
  }
  for (PaperPiece& piece : pieces) {
    if (piece.id < 0 && piece.kind != PaperPiece::Kind::flat) piece.id = next_id++;
  }
}

/// The largest loop of the directed edges, as a polygon.
std::vector<Vector2d> outline(const std::vector<Edge>& boundary, const Eigen::MatrixX2d& pattern) {
  std::vector<Vector2d> best;
  double largest = 0;
  std::vector<bool> used(boundary.size(), false);
  for (std::size_t start = 0; start < boundary.size(); ++start) {
    if (used[start]) continue;
    std::vector<Vector2d> loop;
    std::size_t at = start;
    while (!used[at]) {
      used[at] = true;
      loop.emplace_back(pattern.row(boundary[at][0]));
      for (std::size_t k = 0; k < boundary.size(); ++k) {
        if (!used[k] && boundary[k][0] == boundary[at][1]) {
          at = k;
          break;
        }
      }
    }
    const double area = loop.size() < 3 ? 0 : signed_area({loop});
    if (area > largest) {
      largest = area;
      best = std::move(loop);
    }
  }
  return best;
}

void fill_regions(std::vector<PaperPiece>& pieces, const RulingMesh& mesh,
                  const EdgeConnectivity& edges) {
  std::vector<std::vector<Edge>> boundary(pieces.size());
  const auto piece_of = [&](int f) { return f < 0 ? -1 : mesh.piece[f]; };
  for (int e = 0; e < edges.edge_count(); ++e) {
    const int left = piece_of(edges.left(e)), right = piece_of(edges.right(e));
    if (left == right) continue;
    const auto [a, b] = edges.edge(e);
    if (left >= 0) boundary[left].push_back({a, b});
    if (right >= 0) boundary[right].push_back({b, a});
    if (left >= 0 && right >= 0) {
      pieces[left].neighbours.push_back(right);
      pieces[right].neighbours.push_back(left);
    }
  }
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    pieces[i].region = outline(boundary[i], mesh.mesh.pattern);
    std::vector<int>& near = pieces[i].neighbours;
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
  }
}

void fill_border_points(PaperStructure& structure, const Pattern& pattern) {
  structure.border_points.assign(pattern.border.size(), {});
  std::vector<std::pair<std::pair<int, double>, int>> on_border;
  for (std::size_t s = 0; s < structure.singular_points.size(); ++s) {
    if (!structure.singular_points[s].on_border) continue;
    const BorderPoint at = nearest_on_border(pattern, structure.singular_points[s].position);
    on_border.push_back({{at.edge, at.t}, static_cast<int>(s)});
  }
  std::sort(on_border.begin(), on_border.end());
  for (const auto& [place, s] : on_border) {
    structure.border_points[place.first].push_back(s);
  }
}

/// The bent pieces, and the piece of each bent cell.
std::vector<PaperPiece> bent_pieces(const PaperStructure& structure,
                                    const std::vector<std::vector<int>>& rulings_of_cell,
                                    std::vector<int>& piece_of_cell) {
  const std::size_t cells = rulings_of_cell.size();
  DisjointSets sets(static_cast<int>(structure.rulings.size()));  // rulings that are one piece
  std::vector<std::optional<int>> apex_of(structure.rulings.size());
  std::vector<PaperPiece::Kind> kinds(cells, PaperPiece::Kind::flat);
  for (std::size_t c = 0; c < cells; ++c) {
    const auto [kind, apex] = kind_of_cell(structure, rulings_of_cell[c]);
    if (kind == PaperPiece::Kind::flat) continue;
    const auto i = static_cast<std::size_t>(rulings_of_cell[c][0]);
    const auto j = static_cast<std::size_t>(rulings_of_cell[c][1]);
    // A line between two singular points may bound sectors of both; it is of the first.
    if ((apex_of[i] && apex_of[i] != apex) || (apex_of[j] && apex_of[j] != apex)) continue;
    apex_of[i] = apex_of[j] = apex;
    sets.join(rulings_of_cell[c][0], rulings_of_cell[c][1]);
    kinds[c] = kind;
  }
  std::vector<PaperPiece> pieces;
  std::map<int, int> piece_of_root;
  for (std::size_t c = 0; c < cells; ++c) {
    if (kinds[c] == PaperPiece::Kind::flat) continue;
    const int root = sets.find(rulings_of_cell[c][0]);
    const auto [at, fresh] = piece_of_root.try_emplace(root, static_cast<int>(pieces.size()));
    if (fresh) {
      pieces.emplace_back();
      pieces.back().kind = kinds[c];
    }
    piece_of_cell[c] = at->second;
    std::vector<int>& list = pieces[at->second].rulings;
    list.insert(list.end(), rulings_of_cell[c].begin(), rulings_of_cell[c].end());
  }
  for (PaperPiece& piece : pieces) {
    std::sort(piece.rulings.begin(), piece.rulings.end());
    piece.rulings.erase(std::unique(piece.rulings.begin(), piece.rulings.end()),
                        piece.rulings.end());
    if (piece.kind == PaperPiece::Kind::cone) {
      sort_cone(structure, *apex_of[piece.rulings.front()], piece);
    } else {
      sort_cylinder(structure, piece);
    }
  }
  return pieces;
}

}  // namespace

void derive_pieces(PaperStructure& structure, const Pattern& pattern, RulingMesh& mesh) {
  const EdgeConnectivity edges(mesh.mesh.triangles);
  std::vector<int> piece_of_cell(mesh.cell_count, -1);
  std::vector<PaperPiece> pieces =
      bent_pieces(structure, rulings_of_cells(mesh, edges), piece_of_cell);
  inherit_ids(structure, pieces, structure.next_piece_id);
  for (int& piece : piece_of_cell) {
    if (piece >= 0) continue;
    piece = static_cast<int>(pieces.size());
    pieces.emplace_back();
    pieces.back().id = -1;
  }
  for (Ruling& r : structure.rulings) r.piece = -1;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    for (const int r : pieces[i].rulings) {
      structure.rulings[r].piece = static_cast<int>(i);
    }
  }
  mesh.piece.resize(mesh.cell.size());
  for (std::size_t f = 0; f < mesh.cell.size(); ++f) {
    mesh.piece[f] = piece_of_cell[mesh.cell[f]];
  }
  fill_regions(pieces, mesh, edges);
  structure.pieces = std::move(pieces);
  fill_border_points(structure, pattern);
}

}  // namespace geoprior::paper
