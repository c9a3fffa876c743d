#include "solvers/paper/sheet/pieces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "core/connectivity.h"
#include "core/disjoint_sets.h"
#include "core/geometry/planar.h"
#include "models/paper/contact/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// What bounds a cell.
struct CellOutline {
  std::vector<int> rulings;       ///< each once, sorted
  std::vector<bool> left, right;  ///< the cell lies on that side of the ruling from a to b
  bool at_hole = false;           ///< some of its outline is that of a hole or cut
};

/// Marks the cells that a hole or cut of the pattern borders on.
void mark_holes(const Pattern& pattern, const RulingMesh& mesh, const EdgeConnectivity& edges,
                std::vector<CellOutline>& cells) {
  if (pattern.holes.empty() && pattern.cuts.empty()) return;
  for (int e = 0; e < edges.edge_count(); ++e) {
    const int left = edges.left(e), right = edges.right(e);
    if (left >= 0 && right >= 0) continue;
    const auto [a, b] = edges.edge(e);
    const Vector2d middle = (mesh.mesh.pattern.row(a) + mesh.mesh.pattern.row(b)) / 2;
    if (nearest_on_border(pattern, middle).edge < std::ssize(pattern.border)) continue;
    cells[mesh.cell[std::max(left, right)]].at_hole = true;
  }
}

std::vector<CellOutline> outlines_of_cells(const Pattern& pattern, const RulingMesh& mesh,
                                           const EdgeConnectivity& edges) {
  std::vector<CellOutline> result(mesh.cell_count);
  for (int r = 0; r < std::ssize(mesh.ruling_paths); ++r) {
    const std::vector<int>& path = mesh.ruling_paths[r];
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      const auto e = edges.find(path[k], path[k + 1]);
      if (!e) continue;
      const bool along = edges.edge(*e)[0] == path[k];
      for (const bool left : {true, false}) {
        const int f = left ? edges.left(*e) : edges.right(*e);
        if (f < 0) continue;
        CellOutline& cell = result[mesh.cell[f]];
        if (cell.rulings.empty() || cell.rulings.back() != r) {
          cell.rulings.push_back(r);
          cell.left.push_back(false);
          cell.right.push_back(false);
        }
        (left == along ? cell.left : cell.right).back() = true;
      }
    }
  }
  mark_holes(pattern, mesh, edges, result);
  return result;
}

std::optional<int> common_apex(const Ruling& r, const Ruling& s) {
  for (const auto& p : {r.singular_a, r.singular_b}) {
    if (p && (p == s.singular_a || p == s.singular_b)) return p;
  }
  return std::nullopt;
}

bool are_parallel(const Ruling& r, const Ruling& s) {
  const double angle = line_angle(r.b - r.a, s.b - s.a) * 180 / std::numbers::pi;
  return is_chord(r) && is_chord(s) && angle <= kParallelDegrees;
}

/// Whether a cell at a hole lies between parallel rulings: those of which it lies on one side only
/// are on both sides of it. Those with the cell on both sides end at the hole in its middle.
bool is_strip_at_hole(const PaperStructure& structure, const CellOutline& cell) {
  const Ruling& first = structure.rulings[cell.rulings.front()];
  const Vector2d d = first.b - first.a;
  std::optional<double> low, high;  // of the offsets of rulings before and behind the cell
  for (std::size_t k = 0; k < cell.rulings.size(); ++k) {
    const Ruling& r = structure.rulings[cell.rulings[k]];
    if (!are_parallel(first, r)) return false;
    if (cell.left[k] && cell.right[k]) continue;
    const double offset = cross(d, (r.a + r.b) / 2 - first.a);
    const bool before = cell.left[k] == (d.dot(r.b - r.a) > 0);
    if (before) low = std::max(low.value_or(offset), offset);
    if (!before) high = std::min(high.value_or(offset), offset);
  }
  return low && high && *low < *high;
}

/// The apex that all rulings of a cell have in common.
std::optional<int> common_apex(const PaperStructure& structure, const std::vector<int>& rulings) {
  std::optional<int> apex =
      common_apex(structure.rulings[rulings[0]], structure.rulings[rulings[1]]);
  for (const int i : rulings) {
    const Ruling& r = structure.rulings[i];
    if (apex != r.singular_a && apex != r.singular_b) return std::nullopt;
  }
  return apex;
}

/// The kind that a cell with this outline has, and the apex of a cone.
std::pair<PaperPiece::Kind, std::optional<int>> kind_of_cell(const PaperStructure& structure,
                                                             const CellOutline& cell) {
  const std::vector<int>& rulings = cell.rulings;
  if (cell.at_hole && rulings.size() >= 2) {
    if (const auto apex = common_apex(structure, rulings)) return {PaperPiece::Kind::cone, apex};
    return {is_strip_at_hole(structure, cell) ? PaperPiece::Kind::cylinder : PaperPiece::Kind::flat,
            std::nullopt};
  }
  if (rulings.size() != 2) return {PaperPiece::Kind::flat, std::nullopt};
  const Ruling& r = structure.rulings[rulings[0]];
  const Ruling& s = structure.rulings[rulings[1]];
  if (const auto apex = common_apex(r, s)) return {PaperPiece::Kind::cone, apex};
  return {are_parallel(r, s) ? PaperPiece::Kind::cylinder : PaperPiece::Kind::flat, std::nullopt};
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
  std::rotate(angles.begin(), angles.begin() + first, angles.end());
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
  for (int i = 0; i < std::ssize(pieces); ++i) {
    pieces[i].id = -1;
    std::map<int, int> counts;
    for (const int r : pieces[i].rulings) {
      const int old = before.rulings[r].piece;
      if (old >= 0 && old < std::ssize(before.pieces) &&
          before.pieces[old].kind == pieces[i].kind) {
        ++counts[before.pieces[old].id];
      }
    }
    for (const auto& [id, count] : counts) votes.push_back({count, i, id});
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

/// What the directed edges bound: the largest of their loops, without those that run clockwise.
Pattern region_of(const std::vector<Edge>& boundary, const Eigen::MatrixX2d& pattern) {
  Pattern region;
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
    if (area < 0) region.holes.push_back(std::move(loop));
    if (area > largest) {
      largest = area;
      region.border = std::move(loop);
    }
  }
  return region;
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
    pieces[i].region = region_of(boundary[i], mesh.mesh.pattern);
    std::vector<int>& near = pieces[i].neighbours;
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
  }
}

void fill_border_points(PaperStructure& structure, const Pattern& pattern) {
  structure.border_points.assign(edge_count(pattern), {});
  std::vector<std::pair<std::pair<int, double>, int>> on_border;
  for (int s = 0; s < std::ssize(structure.singular_points); ++s) {
    if (!structure.singular_points[s].on_border) continue;
    const BorderPoint at = nearest_on_border(pattern, structure.singular_points[s].position);
    on_border.push_back({{at.edge, at.t}, s});
  }
  std::sort(on_border.begin(), on_border.end());
  for (const auto& [place, s] : on_border) {
    structure.border_points[place.first].push_back(s);
  }
}

/// The bent pieces, and the piece of each bent cell.
std::vector<PaperPiece> bent_pieces(const PaperStructure& structure,
                                    const std::vector<CellOutline>& outlines,
                                    std::vector<int>& piece_of_cell) {
  const std::size_t cells = outlines.size();
  DisjointSets sets(static_cast<int>(structure.rulings.size()));  // rulings that are one piece
  std::vector<std::optional<int>> apex_of(structure.rulings.size());
  std::vector<PaperPiece::Kind> kinds(cells, PaperPiece::Kind::flat);
  for (std::size_t c = 0; c < cells; ++c) {
    const auto [kind, apex] = kind_of_cell(structure, outlines[c]);
    if (kind == PaperPiece::Kind::flat) continue;
    const std::vector<int>& rulings = outlines[c].rulings;
    // A line between two singular points may bound sectors of both; it is of the first.
    if (std::any_of(rulings.begin(), rulings.end(),
                    [&](int r) { return apex_of[r] && apex_of[r] != apex; })) {
      continue;
    }
    for (const int r : rulings) {
      apex_of[r] = apex;
      sets.join(rulings[0], r);
    }
    kinds[c] = kind;
  }
  std::vector<PaperPiece> pieces;
  std::map<int, int> piece_of_root;
  for (std::size_t c = 0; c < cells; ++c) {
    if (kinds[c] == PaperPiece::Kind::flat) continue;
    const int root = sets.find(outlines[c].rulings[0]);
    const auto [at, fresh] = piece_of_root.try_emplace(root, static_cast<int>(pieces.size()));
    if (fresh) {
      pieces.emplace_back();
      pieces.back().kind = kinds[c];
    }
    piece_of_cell[c] = at->second;
    std::vector<int>& list = pieces[at->second].rulings;
    list.insert(list.end(), outlines[c].rulings.begin(), outlines[c].rulings.end());
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
      bent_pieces(structure, outlines_of_cells(pattern, mesh, edges), piece_of_cell);
  inherit_ids(structure, pieces, structure.next_piece_id);
  for (int& piece : piece_of_cell) {
    if (piece >= 0) continue;
    piece = static_cast<int>(pieces.size());
    pieces.emplace_back();
    pieces.back().id = -1;
  }
  for (Ruling& r : structure.rulings) r.piece = -1;
  for (int i = 0; i < std::ssize(pieces); ++i) {
    for (const int r : pieces[i].rulings) {
      structure.rulings[r].piece = i;
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
