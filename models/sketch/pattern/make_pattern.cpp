#include "models/sketch/pattern/make_pattern.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "core/angles.h"
#include "core/geometry/planar.h"
#include "core/parallel.h"
#include "models/sketch/pattern/layout.h"
#include "models/sketch/pattern/piece_border.h"
#include "models/sketch/surface/shortest_cut.h"

namespace geoprior::sketch {
namespace {

/// Of the surface's upward direction in the pattern, below which a piece has none.
constexpr double kLeastUp = 0.1;

std::vector<SeamEdge> opening_seams(const std::vector<CutPiece>& pieces, int seam,
                                    const PatternOptions& options) {
  std::vector<SeamEdge> added;
  for (const CutPiece& piece : pieces) {
    if (can_be_laid_flat(piece, options.hole_tolerance_deg * kDegree)) continue;
    for (const Edge& edge : shortest_cut(piece.mesh))
      added.push_back({{piece.surface_vertex[edge[0]], piece.surface_vertex[edge[1]]}, seam});
    ++seam;
  }
  return added;
}

/// Mean over the area of the gradient, in the plane, of a value at the vertices.
Eigen::Vector2d mean_gradient(const PatternPiece& piece, const Eigen::VectorXd& value) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double area = 0;
  for (Eigen::Index t = 0; t < piece.triangles.rows(); ++t) {
    const auto corner = [&](int k) -> Eigen::Vector2d {
      return piece.points.row(piece.triangles(t, k)).transpose();
    };
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2d opposite = corner((k + 2) % 3) - corner((k + 1) % 3);
      sum += value(piece.triangles(t, k)) * Eigen::Vector2d(-opposite.y(), opposite.x()) / 2;
    }
    area += cross(corner(1) - corner(0), corner(2) - corner(0)) / 2;
  }
  return area > 0 ? Eigen::Vector2d(sum / area) : sum;
}

/// Axis of the largest second moment of area.
Eigen::Vector2d longest_axis(const PatternPiece& piece) {
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  Eigen::Vector2d first = Eigen::Vector2d::Zero();
  double area = 0;
  for (Eigen::Index t = 0; t < piece.triangles.rows(); ++t) {
    std::array<Eigen::Vector2d, 3> corner;
    for (int k = 0; k < 3; ++k) corner[k] = piece.points.row(piece.triangles(t, k)).transpose();
    const double weight = cross(corner[1] - corner[0], corner[2] - corner[0]) / 2;
    const Eigen::Vector2d sum = corner[0] + corner[1] + corner[2];
    moment += weight / 12 * (sum * sum.transpose());
    for (const Eigen::Vector2d& c : corner) moment += weight / 12 * (c * c.transpose());
    first += weight / 3 * sum;
    area += weight;
  }
  if (!(area > 0)) return {0, 1};
  moment -= first * first.transpose() / area;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moment).eigenvectors().col(1);
}

void turn_to_grain(PatternPiece& piece, const Eigen::VectorXd& height, GrainRule rule) {
  const Eigen::Vector2d up = mean_gradient(piece, height);
  Eigen::Vector2d grain = up;
  if (rule == GrainRule::longest || up.norm() < kLeastUp) {
    grain = longest_axis(piece);
    if (grain.dot(up) < 0) grain = -grain;
  }
  grain.normalize();
  Eigen::Matrix2d turn;  // carries the grain to +y
  turn << grain.y(), -grain.x(), grain.x(), grain.y();
  piece.points = (piece.points * turn.transpose()).eval();
  piece.grain = {0, 1};
}

double border_area(const Eigen::MatrixX2d& points, const std::vector<int>& loop) {
  double twice = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    twice +=
        cross(points.row(loop[i]).transpose(), points.row(loop[(i + 1) % loop.size()]).transpose());
  }
  return twice / 2;
}

double flat_length(const Flattening& flat, const PieceEdge& edge) {
  double length = 0;
  for (std::size_t i = 1; i < edge.vertices.size(); ++i)
    length += (flat.points.row(edge.vertices[i]) - flat.points.row(edge.vertices[i - 1])).norm();
  return length;
}

/// What the sewn stretches of a piece are to be held at so that both sides of each seam differ by
/// at most `mismatch` of their length: what the two have freely, moved towards each other. Empty
/// when they agree already.
std::vector<KeptLength> agreed_lengths(const std::vector<CutPiece>& cut,
                                       const std::vector<Flattening>& flat, std::size_t piece,
                                       double mismatch) {
  std::vector<KeptLength> kept;
  bool agree = true;
  for (const PieceEdge& edge : cut[piece].edges) {
    if (edge.partner_piece < 0) continue;
    const std::size_t other = edge.partner_piece;
    const double here = flat_length(flat[piece], edge);
    const double there = flat_length(flat[other], cut[other].edges[edge.partner_edge]);
    const double mean = (here + there) / 2, most = mismatch * mean / 2;
    const double apart = std::clamp((here - there) / 2, -most, most);
    agree = agree && std::abs(here - there) / 2 <= most;
    kept.push_back({edge.vertices, mean + apart});
  }
  return agree ? std::vector<KeptLength>() : kept;
}

PatternPiece finished_piece(const CutPiece& cut, Flattening flat, GrainRule grain) {
  PatternPiece piece;
  piece.points = std::move(flat.points);
  piece.triangles = cut.mesh.F;
  piece.surface_vertex = cut.surface_vertex;
  piece.surface_triangle = cut.surface_triangle;
  piece.borders = cut.borders;
  piece.edges = cut.edges;
  turn_to_grain(piece, cut.mesh.V.col(1), grain);
  std::stable_sort(piece.borders.begin(), piece.borders.end(), [&](const auto& a, const auto& b) {
    return border_area(piece.points, a) > border_area(piece.points, b);
  });
  return piece;
}

/// Calls for every piece in parallel; of several errors the one of the first piece is thrown.
template <class Work>
void for_each_piece(std::size_t count, Work work) {
  std::vector<std::exception_ptr> errors(count);
  parallel_blocks(count, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      try {
        work(p);
      } catch (...) {
        errors[p] = std::current_exception();
      }
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

void lay_pieces(const std::vector<CutPiece>& cut, const PatternOptions& options,
                MadePattern& made) {
  std::vector<Flattening> flat(cut.size());
  for_each_piece(cut.size(), [&](std::size_t p) {
    flat[p] = options.lay_disc ? Flattening{options.lay_disc(cut[p].mesh), {}}
                               : flatten(cut[p].mesh, options.flatten);
  });
  if (options.equal_seams && !options.lay_disc) {
    const std::vector<Flattening> freely = flat;
    for_each_piece(cut.size(), [&](std::size_t p) {
      const std::vector<KeptLength> kept = agreed_lengths(cut, freely, p, options.seam_mismatch);
      if (!kept.empty()) hold_lengths(cut[p].mesh, kept, options.flatten, flat[p]);
    });
  }
  made.pattern.pieces.resize(cut.size());
  made.reports.resize(cut.size());
  for_each_piece(cut.size(), [&](std::size_t p) {
    made.reports[p] = flat[p].report;
    made.pattern.pieces[p] = finished_piece(cut[p], std::move(flat[p]), options.grain);
    made.pattern.pieces[p].name = "piece " + std::to_string(p + 1);
  });
}

}  // namespace

void describe(OptionVisitor& v, PatternOptions& options) {
  static constexpr std::array<std::string_view, 2> kGrainRules{"up", "longest"};
  describe_group(v, "flatten", options.flatten, {.doc = "how a piece is laid flat"});
  describe_choice(
      v, "grain", options.grain, kGrainRules,
      {.doc = "what of a piece points upwards: the surface's up, or its longest direction"});
  v.value("gap", options.gap,
          {.doc = "least distance between the boxes of pieces", .unit = "m", .min = 0});
  v.value(
      "width", options.width,
      {.doc = "width of the pattern's shelves; about a square when absent", .unit = "m", .min = 0});
  v.value("equal_seams", options.equal_seams,
          {.doc = "whether both sides of every seam are brought to one length"});
  v.value("seam_mismatch", options.seam_mismatch,
          {.doc = "relative difference that both sides of a seam may keep", .min = 0, .max = 1});
  v.value(
      "hole_tolerance_deg", options.hole_tolerance_deg,
      {.doc = "tolerance on -360 degrees within which a border's turn makes it a hole that stays",
       .unit = "deg",
       .min = 0,
       .max = 180});
  v.value(
      "most_pieces", options.most_pieces,
      {.doc = "most pieces that suggested seams may make; 0: any number", .min = 0, .max = 1000});
}

bool can_be_laid_flat(const CutPiece& piece, double hole_tolerance) {
  if (piece.borders.empty() || piece.genus() != 0) return false;
  if (piece.is_disc()) return true;
  int holes = 0;
  for (const double turning : border_turnings(piece))
    holes += std::abs(turning + 2 * std::numbers::pi) <= hole_tolerance ? 1 : 0;
  return holes == piece.border_count() - 1;
}

MadePattern make_pattern(const TriMesh& surface, std::span<const SeamEdge> seams,
                         const PatternOptions& options) {
  MadePattern made;
  std::vector<CutPiece> pieces = cut_surface(surface, seams);
  int next_seam = 0;
  for (const SeamEdge& edge : seams) next_seam = std::max(next_seam, edge.seam + 1);
  made.added_seams = opening_seams(pieces, next_seam, options);
  if (!made.added_seams.empty()) {
    std::vector<SeamEdge> all(seams.begin(), seams.end());
    all.insert(all.end(), made.added_seams.begin(), made.added_seams.end());
    pieces = cut_surface(surface, all);
  }
  lay_pieces(pieces, options, made);
  lay_on_shelves(made.pattern, {.gap = options.gap, .width = options.width});
  return made;
}

std::vector<SeamMismatch> seam_mismatches(const Pattern& pattern) {
  std::vector<SeamMismatch> mismatches;
  for (int p = 0; p < std::ssize(pattern.pieces); ++p) {
    const PatternPiece& piece = pattern.pieces[p];
    for (int e = 0; e < std::ssize(piece.edges); ++e) {
      const PieceEdge& edge = piece.edges[e];
      if (edge.partner_piece < 0 ||
          std::pair(edge.partner_piece, edge.partner_edge) < std::pair(p, e)) {
        continue;
      }
      const PatternPiece& other = pattern.pieces[edge.partner_piece];
      const double a = edge_length(piece, edge);
      const double b = edge_length(other, other.edges[edge.partner_edge]);
      mismatches.push_back({p, e, edge.seam, a + b > 0 ? 2 * std::abs(a - b) / (a + b) : 0});
    }
  }
  return mismatches;
}

}  // namespace geoprior::sketch
