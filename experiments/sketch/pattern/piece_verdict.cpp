#include "experiments/sketch/pattern/piece_verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/error.h"
#include "core/mesh.h"
#include "metrics/arrangement/lengths.h"
#include "metrics/isometry/flattening.h"
#include "models/sketch/pattern/piece_border.h"
#include "solvers/sketch/pattern/seam_suggestion.h"

namespace geoprior::sketch {
namespace {

constexpr double kMostWritten = 9.99;  ///< strain; a collapsed triangle has any

std::string percent(double share, int digits) {
  std::array<char, 32> text{};
  const double value = 100 * std::min(share, kMostWritten);
  std::snprintf(text.data(), text.size(), "%.*f %%", value < 9.95 ? digits : 0, value);
  return text.data();
}

std::string whole_millimetres(double metres) {
  const auto mm = std::lround(1000 * metres);
  return std::to_string(mm);
}

FlatPiece flat_piece(const PatternPiece& piece, const Eigen::MatrixX3d& surface,
                     const std::string& label) {
  FlatPiece flat{piece.points, Eigen::MatrixX3d(piece.points.rows(), 3), piece.triangles};
  if (std::ssize(piece.surface_vertex) != piece.points.rows()) {
    throw Error(
        "has surface vertices for " + std::to_string(piece.surface_vertex.size()) + " points",
        label, std::to_string(piece.points.rows()));
  }
  for (Eigen::Index i = 0; i < flat.x.rows(); ++i) {
    const int v = piece.surface_vertex[i];
    if (v < 0 || v >= surface.rows()) {
      throw Error("counts vertex " + std::to_string(v) + " of the surface", label,
                  "0 to " + std::to_string(surface.rows() - 1));
    }
    flat.x.row(i) = surface.row(v);
  }
  return flat;
}

double distance_from_edge(const PatternPiece& piece, const PieceEdge& edge,
                          const Eigen::Vector2d& p) {
  const auto in_space = [](const Eigen::Vector2d& at) {
    return Eigen::Vector3d(at.x(), at.y(), 0);
  };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < edge.vertices.size(); ++i) {
    least = std::min(
        least, distance_from_segment(in_space(p), in_space(piece.points.row(edge.vertices[i - 1])),
                                     in_space(piece.points.row(edge.vertices[i]))));
  }
  return least;
}

std::string nearest_edge(const PatternPiece& piece, const Eigen::Vector2d& p) {
  const PieceEdge* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const PieceEdge& edge : piece.edges) {
    const double distance = distance_from_edge(piece, edge, p);
    if (distance >= least) continue;
    least = distance;
    nearest = &edge;
  }
  if (nearest == nullptr) return "the border";
  if (!nearest->name.empty())
    return (nearest->partner_piece < 0 ? "border '" : "seam '") + nearest->name + "'";
  return nearest->partner_piece < 0 ? "a border" : "seam " + std::to_string(nearest->seam + 1);
}

void find_worst(const FlatPiece& flat, const PatternPiece& piece, PieceVerdict& verdict) {
  const Eigen::MatrixX2d s = flattening_singular_values(flat);
  Eigen::Index worst = 0;
  for (Eigen::Index t = 0; t < s.rows(); ++t) {
    const double strain = std::max(s(t, 0), 1 / std::max(s(t, 1), 1e-6)) - 1;
    if (strain <= verdict.worst) continue;
    verdict.worst = strain;
    worst = t;
  }
  for (int k = 0; k < 3; ++k) {
    verdict.worst_flat += flat.points.row(piece.triangles(worst, k)).transpose() / 3;
    verdict.worst_place += flat.x.row(piece.triangles(worst, k)).transpose() / 3;
  }
  verdict.nearest = nearest_edge(piece, verdict.worst_flat);
}

std::string reason_to_refuse(const PieceVerdict& verdict) {
  if (verdict.flips > 0) {
    return std::to_string(verdict.flips) +
           (verdict.flips == 1 ? " triangle is" : " triangles are") + " turned over";
  }
  if (std::abs(verdict.area_error) <= kRefusedArea) return {};
  return "is " + percent(std::abs(verdict.area_error), 1) +
         (verdict.area_error < 0 ? " smaller" : " larger") + " than its surface (at most " +
         percent(kRefusedArea, 0) + ")";
}

}  // namespace

std::vector<PieceVerdict> judge_pieces(const Pattern& pattern, const Eigen::MatrixX3d& surface) {
  std::vector<PieceVerdict> verdicts;
  for (int p = 0; p < std::ssize(pattern.pieces); ++p) {
    const PatternPiece& piece = pattern.pieces[p];
    const FlatPiece flat = flat_piece(piece, surface, piece_label(pattern, p));
    PieceVerdict& verdict = verdicts.emplace_back();
    if (flat.triangles.rows() == 0) continue;
    const FlatteningSummary summary = flattening({&flat, 1});
    verdict.area = triangle_areas(flat.x, flat.triangles).sum();
    verdict.strain_p95 = summary.stretch_p95 - 1;
    verdict.share = summary.stretch_share[1];
    verdict.area_error = summary.area_ratio - 1;
    verdict.flips = summary.flips;
    find_worst(flat, piece, verdict);
    verdict.refused = reason_to_refuse(verdict);
  }
  return verdicts;
}

Eigen::VectorXd signed_strain(const PatternPiece& piece, const Eigen::MatrixX3d& surface) {
  const Eigen::MatrixX2d s =
      flattening_singular_values(flat_piece(piece, surface, "piece '" + piece.name + "'"));
  Eigen::VectorXd strain(s.rows());
  for (Eigen::Index t = 0; t < s.rows(); ++t) {
    const double longer = 1 / std::max(s(t, 1), 1e-6), shorter = s(t, 0);
    strain(t) = longer >= shorter ? longer - 1 : 1 - shorter;
  }
  return strain;
}

AddedSeam added_seam(const PatternPiece& piece, const Eigen::MatrixX3d& surface) {
  AddedSeam added;
  const FlatPiece flat = flat_piece(piece, surface, "piece '" + piece.name + "'");
  SeamSuggestionOptions options;
  options.count = 1;
  options.symmetric = false;
  std::vector<SuggestedSeam> suggested;
  try {
    suggested = suggest_seams({flat.x, flat.triangles}, {}, options);
  } catch (const Error&) {
    return added;  // a piece that cannot be laid flat at all
  }
  if (suggested.empty()) return added;
  added.is_dart = suggested[0].is_dart;
  added.share = suggested[0].share_after;
  Eigen::MatrixX3d in_plane = Eigen::MatrixX3d::Zero(flat.points.rows(), 3);
  in_plane.leftCols<2>() = flat.points;
  for (const SurfacePath& path : suggested[0].cut) {
    std::vector<Eigen::Vector2d>& line = added.lines.emplace_back();
    for (const EdgePoint& point : path)
      line.emplace_back(point.position(in_plane).head<2>().transpose());
  }
  return added;
}

std::string short_verdict(const PieceVerdict& verdict) {
  return "strain p95 " + percent(verdict.strain_p95, 1) + ", " + percent(verdict.share, 0) +
         " of the area within " + percent(kTakenStrain, 0);
}

std::string counted_piece(const Pattern& pattern, int piece) {
  return "piece " + std::to_string(piece + 1) + " of " + std::to_string(pattern.pieces.size()) +
         " '" + pattern.pieces[piece].name + "'";
}

std::string verdict_line(const Pattern& pattern, int piece, const PieceVerdict& verdict) {
  std::string line = counted_piece(pattern, piece) + ": ";
  if (!verdict.refused.empty()) line += "REFUSED, " + verdict.refused + "; ";
  line += short_verdict(verdict) + "; worst " + percent(verdict.worst, 1) + " near " +
          verdict.nearest + ", in the pattern at x " + whole_millimetres(verdict.worst_flat.x()) +
          ", y " + whole_millimetres(verdict.worst_flat.y()) + " mm, on the surface at x " +
          whole_millimetres(verdict.worst_place.x()) + ", y " +
          whole_millimetres(verdict.worst_place.y()) + ", z " +
          whole_millimetres(verdict.worst_place.z()) + " mm";
  if (!verdict.seam.lines.empty()) {
    line += std::string("; add a ") + (verdict.seam.is_dart ? "dart" : "seam") +
            " along the dashed line of pattern-strain.svg: " + percent(verdict.seam.share, 0) +
            " within " + percent(kTakenStrain, 0);
  }
  return line;
}

}  // namespace geoprior::sketch
