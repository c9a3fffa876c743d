#include "solvers/sketch/pattern/fair_seams.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "core/connectivity.h"
#include "core/geometry/surface_point.h"
#include "core/geometry/topology.h"
#include "core/geometry/triangle_tree.h"
#include "models/sketch/ridges/edge_flips.h"

namespace geoprior::sketch {
namespace {

constexpr int kSamplesOfWidth = 4;
constexpr int kMostSamples = 600;  ///< of a line
constexpr double kFairWidth = 1;   ///< of seams, in mean edges of the surface
constexpr int kFollowRings = 3;    ///< about a seam, whose vertices follow it
constexpr int kSteps = 24;
constexpr int kEvenPasses = 8;        ///< of steps along a seam
constexpr int kFollowPasses = 4;      ///< in every step
constexpr double kMostMove = 0.25;    ///< of a vertex of a seam in a step, in mean edges
constexpr double kMostOff = 0.1;      ///< from the surface, likewise
constexpr double kLeastTurned = 0.3;  ///< cosine between a triangle's normal before and after
constexpr double kLeastArea = 0.1;    ///< of a triangle, over its area before and the mean
constexpr int kFlipPasses = 3;        ///< in every step
constexpr double kFlatEdge = 0.94;    ///< cosine between the normals beside an edge that is flipped
constexpr double kRounder = 1.2;      ///< how much rounder triangles are that a flip makes

bool is_closed(const Eigen::MatrixX3d& line) {
  return line.rows() > 3 && line.row(0) == line.row(line.rows() - 1);
}

std::vector<double> arc_lengths(const Eigen::MatrixX3d& line) {
  std::vector<double> along{0};
  for (Eigen::Index i = 1; i < line.rows(); ++i)
    along.push_back(along.back() + (line.row(i) - line.row(i - 1)).norm());
  return along;
}

/// Rows of a value at places along a line.
Eigen::MatrixX3d at_lengths(const Eigen::MatrixX3d& rows, const std::vector<double>& along,
                            const std::vector<double>& places) {
  Eigen::MatrixX3d result(places.size(), 3);
  std::size_t k = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    while (k + 2 < along.size() && along[k + 1] < places[i]) ++k;
    const double step = along[k + 1] - along[k];
    const double share = step > 0 ? std::clamp((places[i] - along[k]) / step, 0.0, 1.0) : 0;
    result.row(i) = (1 - share) * rows.row(k) + share * rows.row(k + 1);
  }
  return result;
}

std::vector<double> even_places(double length, double width) {
  const auto steps = std::clamp(static_cast<int>(std::ceil(kSamplesOfWidth * length / width)),
                                kSamplesOfWidth, kMostSamples);
  std::vector<double> places;
  for (int i = 0; i <= steps; ++i) places.push_back(length * i / steps);
  return places;
}

/// Chains of seam edges between vertices where they end, branch or must stay.
std::vector<std::vector<int>> seam_chains(std::span<const SeamEdge> seams,
                                          const std::vector<char>& stays) {
  std::vector<std::vector<int>> beside(stays.size());
  for (const SeamEdge& e : seams) {
    beside[e.edge[0]].push_back(e.edge[1]);
    beside[e.edge[1]].push_back(e.edge[0]);
  }
  std::set<Edge> done;
  std::vector<std::vector<int>> chains;
  const auto follow = [&](int from, int to) {
    std::vector<int> chain{from};
    while (done.insert(undirected(from, to)).second) {
      chain.push_back(to);
      if (stays[to] || beside[to].size() != 2) break;
      const int next = beside[to][0] == from ? beside[to][1] : beside[to][0];
      from = to;
      to = next;
    }
    if (chain.size() > 2) chains.push_back(std::move(chain));
  };
  for (const bool from_end : {true, false}) {
    for (int v = 0; v < std::ssize(beside); ++v) {
      if (beside[v].empty() || (stays[v] || beside[v].size() != 2) != from_end) continue;
      for (const int w : beside[v]) follow(v, w);
    }
  }
  return chains;
}

class SeamFairing {
 public:
  SeamFairing(const TriMesh& surface, std::span<const SeamEdge> seams,
              std::span<const SeamEdge> kept)
      : surface_(surface),
        tree_(surface),
        rings_(one_rings(surface.F, surface.vertex_count())),
        normals_(triangle_normals(surface)),
        areas_(triangle_areas(surface.V, surface.F)),
        X_(surface.V),
        F_(surface.F),
        stays_(surface.vertex_count(), 0) {
    for (const std::span<const SeamEdge> of : {seams, kept}) {
      for (const SeamEdge& e : of) seam_edges_.insert(undirected(e.edge[0], e.edge[1]));
    }
    const std::vector<bool> border = boundary_vertices(surface.F, surface.vertex_count());
    for (int v = 0; v < surface.vertex_count(); ++v) stays_[v] = border[v] ? 1 : 0;
    for (const SeamEdge& e : kept) stays_[e.edge[0]] = stays_[e.edge[1]] = 1;
    chains_ = seam_chains(seams, stays_);
    mean_area_ = areas_.mean();
    width_ = kFairWidth * mean_edge_length(surface.V, EdgeConnectivity(surface.F));
  }

  TriMesh fair() {
    find_near();
    std::vector<Eigen::MatrixX3d> places;
    for (const std::vector<int>& chain : chains_) places.push_back(places_of(chain, kEvenPasses));
    for (int step = 0; step < kSteps && !chains_.empty(); ++step) {
      before_ = X_;
      for (std::size_t i = 0; i < chains_.size(); ++i) slide(chains_[i], places[i]);
      follow();
      flip_stretched();
      undo_turned();
    }
    leave_surface();
    return {std::move(X_), std::move(F_)};
  }

 private:
  [[nodiscard]] Eigen::RowVector3d on_surface(const Eigen::RowVector3d& x) const {
    const SurfacePoint at = tree_.nearest(x.transpose()).point;
    return position_of(at, surface_.V, surface_.F).transpose();
  }

  /// Points of a line made fair, where its vertices are to go: each to its own point, but for short
  /// and long steps that are evened out. Lengths are those along the line as it is: along the fair
  /// one, rough stretches are shorter, and what lies behind them would be drawn towards them.
  [[nodiscard]] Eigen::MatrixX3d places_of(const std::vector<int>& chain, int even_passes) const {
    const Eigen::MatrixX3d line = X_(chain, Eigen::all);
    const Eigen::MatrixX3d fair = faired_line(line, width_);
    std::vector<double> places = arc_lengths(line);
    const std::vector<double> of_fair = even_places(places.back(), width_);
    for (int pass = 0; pass < even_passes; ++pass) {
      const std::vector<double> before = places;
      for (std::size_t i = 1; i + 1 < places.size(); ++i)
        places[i] = (before[i - 1] + 2 * before[i] + before[i + 1]) / 4;
    }
    return at_lengths(fair, of_fair, places);
  }

  /// Vertices of a chain that may move, towards their places.
  /// @param most  in mean edges
  void move_towards(const std::vector<int>& chain, const Eigen::MatrixX3d& places, double most) {
    const bool closed = chain.front() == chain.back();
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const int v = chain[i];
      if (stays_[v] || (!closed && i + 1 == chain.size())) continue;
      const Eigen::RowVector3d move = places.row(static_cast<Eigen::Index>(i)) - X_.row(v);
      X_.row(v) += std::min(1.0, most * width_ / kFairWidth / std::max(move.norm(), 1e-300)) * move;
    }
  }

  void slide(const std::vector<int>& chain, const Eigen::MatrixX3d& places) {
    move_towards(chain, places, kMostMove);
    for (const int v : chain)
      if (!stays_[v]) X_.row(v) = on_surface(X_.row(v));
  }

  /// The surface is as rough as its triangles are: of what that leaves of a seam's roughness as
  /// much is taken off as little leaving it does.
  void leave_surface() {
    before_ = X_;
    std::vector<Eigen::MatrixX3d> places;
    for (const std::vector<int>& chain : chains_) places.push_back(places_of(chain, 0));
    for (std::size_t i = 0; i < chains_.size(); ++i) move_towards(chains_[i], places[i], kMostOff);
    const Eigen::MatrixX3d moves = followed(X_ - before_);
    for (const int v : near_) X_.row(v) = before_.row(v) + moves.row(v);
    undo_turned();
  }

  /// Vertices about the seams, seams left out.
  void find_near() {
    std::vector<int> front;
    std::vector<char> taken = stays_;
    for (const std::vector<int>& chain : chains_) {
      for (const int v : chain) taken[v] = 1;
      front.insert(front.end(), chain.begin(), chain.end());
    }
    for (int ring = 0; ring < kFollowRings; ++ring) {
      std::vector<int> next;
      for (const int v : front) {
        for (const int w : rings_.of(v)) {
          if (std::exchange(taken[w], 1) == 0) next.push_back(w);
        }
      }
      near_.insert(near_.end(), next.begin(), next.end());
      front = std::move(next);
    }
    moves_.assign(stays_.size(), 0);
    for (const std::vector<int>& chain : chains_) {
      for (const int v : chain) moves_[v] = 1;
    }
    for (const int v : near_) moves_[v] = 1;
  }

  /// Vertices near to seams move by the mean of what their neighbours move by; the farther ones and
  /// those that stay do not move.
  [[nodiscard]] Eigen::MatrixX3d followed(Eigen::MatrixX3d moves) const {
    for (int pass = 0; pass < kFollowPasses; ++pass) {
      for (const int v : near_) {
        Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
        int count = 0;
        for (const int w : rings_.of(v)) {
          sum += moves.row(w);
          ++count;
        }
        moves.row(v) = sum / count;
      }
    }
    return moves;
  }

  void follow() {
    const Eigen::MatrixX3d moves = followed(X_ - surface_.V);
    for (const int v : near_) X_.row(v) = on_surface(surface_.V.row(v) + moves.row(v));
  }

  [[nodiscard]] bool is_right(const Eigen::RowVector3d& area_normal,
                              const Eigen::RowVector3d& should, double least) const {
    const double length = area_normal.norm();
    return length / 2 > least && area_normal.dot(should) > kLeastTurned * length * should.norm();
  }

  /// Whether an edge about the seams, which is no seam and on no sharp edge of the surface, is
  /// better flipped: a triangle beside it is turned over, or the two become rounder. Those that
  /// come of it are right before the step and after it, so that the step can be taken back.
  [[nodiscard]] bool is_flip_wanted(const EdgeDiamond& of) const {
    const auto& [left, right, a, b, c, d, around] = of;
    if (!moves_[a] && !moves_[b] && !moves_[c] && !moves_[d]) return false;
    if (normals_.row(left).dot(normals_.row(right)) < kFlatEdge) return false;
    if (seam_edges_.contains(undirected(a, b))) return false;
    const Eigen::RowVector3d should = normals_.row(left) + normals_.row(right);
    const double least = kLeastArea * std::min((areas_(left) + areas_(right)) / 2, mean_area_);
    for (const Eigen::MatrixX3d* X : {&before_, &std::as_const(X_)}) {
      if (!is_right(area_normal(*X, c, d, b), should, least)) return false;
      if (!is_right(area_normal(*X, d, c, a), should, least)) return false;
    }
    const bool is_bad = !is_right(area_normal(X_, a, b, c), normals_.row(left), least) ||
                        !is_right(area_normal(X_, b, a, d), normals_.row(right), least);
    return is_bad || std::min(roundness(c, d, b), roundness(d, c, a)) >
                         kRounder * std::min(roundness(a, b, c), roundness(b, a, d));
  }

  [[nodiscard]] static Eigen::RowVector3d area_normal(const Eigen::MatrixX3d& X, int a, int b,
                                                      int c) {
    const Eigen::RowVector3d u = X.row(b) - X.row(a), v = X.row(c) - X.row(a);
    return u.cross(v);
  }

  /// Area over that of the square of the edges; most for an equilateral triangle.
  [[nodiscard]] double roundness(int a, int b, int c) const {
    const double edges = (X_.row(a) - X_.row(b)).squaredNorm() +
                         (X_.row(b) - X_.row(c)).squaredNorm() +
                         (X_.row(c) - X_.row(a)).squaredNorm();
    return area_normal(X_, a, b, c).norm() / edges;
  }

  void flip_stretched() {
    bool any = false;
    for (int pass = 0; pass < kFlipPasses; ++pass) {
      const Eigen::MatrixX3i F = F_;
      if (flip_edges(F_, [&](const EdgeDiamond& of) { return is_flip_wanted(of); }) == 0) break;
      any = true;
      for (Eigen::Index t = 0; t < F.rows(); ++t) {
        if (F.row(t) == F_.row(t)) continue;
        const Eigen::RowVector3d n = area_normal(before_, F_(t, 0), F_(t, 1), F_(t, 2));
        areas_(t) = n.norm() / 2;
        normals_.row(t) = n.normalized();
      }
    }
    if (any) rings_ = one_rings(F_, surface_.vertex_count());
  }

  /// Takes back the step of every triangle that it turned over or left without area.
  void undo_turned() {
    for (bool changed = true; changed;) {
      changed = false;
      const TriMesh now{X_, F_};
      const Eigen::MatrixX3d normals = triangle_normals(now);
      const Eigen::VectorXd areas = triangle_areas(now.V, now.F);
      for (int t = 0; t < now.triangle_count(); ++t) {
        const double least = kLeastArea * std::min(areas_(t), mean_area_);
        if (normals.row(t).dot(normals_.row(t)) > kLeastTurned && areas(t) > least) continue;
        for (int k = 0; k < 3; ++k) {
          const int v = F_(t, k);
          changed = changed || X_.row(v) != before_.row(v);
          X_.row(v) = before_.row(v);
        }
      }
    }
  }

  const TriMesh& surface_;
  TriangleTree tree_;
  VertexGraph rings_;
  Eigen::MatrixX3d normals_;  ///< of the triangles as they were, or when a flip made them
  Eigen::VectorXd areas_;
  double mean_area_ = 0;
  Eigen::MatrixX3d X_, before_;  ///< before the step that is made
  Eigen::MatrixX3i F_;
  std::set<Edge> seam_edges_;
  std::vector<char> moves_;  ///< vertices of seams, and those about them
  std::vector<char> stays_;
  std::vector<std::vector<int>> chains_;
  std::vector<int> near_;
  double width_ = 0;
};

}  // namespace

Eigen::MatrixX3d faired_line(const Eigen::MatrixX3d& line, double width) {
  const std::vector<double> along = arc_lengths(line);
  if (line.rows() < 3 || !(along.back() > 0)) return line;
  const bool closed = is_closed(line);
  Eigen::MatrixX3d p = at_lengths(line, along, even_places(along.back(), width));
  const auto n = static_cast<int>(p.rows()) - (closed ? 1 : 0);
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n, n);
  const double weight = std::pow(kSamplesOfWidth, 4);
  for (int i = closed ? 0 : 1; i < (closed ? n : n - 1); ++i) {
    const int a = (i + n - 1) % n, b = (i + 1) % n;
    const std::array<std::pair<int, double>, 3> row{{{a, 1}, {i, -2}, {b, 1}}};
    for (const auto& [r, x] : row) {
      for (const auto& [c, y] : row) A(r, c) += weight * x * y;
    }
  }
  Eigen::MatrixX3d right = p.topRows(n);
  if (!closed) {
    // Ends stay: what their columns say goes to the other side.
    for (const int end : {0, n - 1}) {
      right -= A.col(end) * p.row(end);
      A.col(end).setZero();
      A.row(end).setZero();
      A(end, end) = 1;
    }
    right.row(0) = p.row(0);
    right.row(n - 1) = p.row(n - 1);
  }
  p.topRows(n) = Eigen::LDLT<Eigen::MatrixXd>(A).solve(right);
  if (closed) p.row(n) = p.row(0);
  return p;
}

CutLines faired_lines(const CutLines& lines, double width) {
  CutLines faired;
  for (std::size_t i = 0; i < lines.points.size(); ++i) {
    const Eigen::MatrixX3d& line = lines.points[i];
    const std::vector<double> along = arc_lengths(line);
    if (line.rows() < 3 || !(along.back() > 0)) {
      faired.points.push_back(line);
      faired.normals.push_back(lines.normals[i]);
    } else {
      faired.points.push_back(faired_line(line, width));
      faired.normals.push_back(at_lengths(lines.normals[i], along, even_places(along.back(), width))
                                   .rowwise()
                                   .normalized());
    }
    faired.length += arc_lengths(faired.points.back()).back();
  }
  return faired;
}

TriMesh fair_seams(const TriMesh& surface, std::span<const SeamEdge> seams,
                   std::span<const SeamEdge> kept) {
  return SeamFairing(surface, seams, kept).fair();
}

}  // namespace geoprior::sketch
