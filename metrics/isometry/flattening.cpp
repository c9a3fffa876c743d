#include "metrics/isometry/flattening.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "core/mesh.h"
#include "metrics/contact/planar_overlap.h"
#include "metrics/isometry/distortion.h"
#include "metrics/tracks/weighted_quantile.h"

namespace geoprior {
namespace {

constexpr double kCollapsed = 1e-6;

void require_piece(const FlatPiece& piece) {
  if (piece.points.rows() != piece.x.rows()) {
    throw Error(std::to_string(piece.points.rows()) + " points", "flattening",
                std::to_string(piece.x.rows()) + ", as on the surface");
  }
  if (!piece.points.allFinite() || !piece.x.allFinite())
    throw Error("coordinate is not finite", "flattening", "finite numbers");
}

/// Singular values and weights of the triangles of all pieces.
struct FlatTriangles {
  Eigen::ArrayX2d s;    ///< larger, smaller
  Eigen::ArrayXd area;  ///< on the surface (m^2)
};

FlatTriangles triangles_of_pieces(std::span<const FlatPiece> pieces) {
  Eigen::Index count = 0;
  for (const FlatPiece& piece : pieces) count += piece.triangles.rows();
  FlatTriangles all{Eigen::ArrayX2d(count, 2), Eigen::ArrayXd(count)};
  Eigen::Index at = 0;
  for (const FlatPiece& piece : pieces) {
    const Eigen::Index n = piece.triangles.rows();
    all.s.middleRows(at, n) = flattening_singular_values(piece).array().max(kCollapsed);
    all.area.segment(at, n) = triangle_areas(piece.x, piece.triangles).array();
    at += n;
  }
  if (!(all.area.sum() > 0)) throw Error("no triangle with an area", "flattening", "at least one");
  return all;
}

int flipped_triangles(const FlatPiece& piece) {
  int flips = 0;
  for (Eigen::Index t = 0; t < piece.triangles.rows(); ++t) {
    const Eigen::Vector3i f = piece.triangles.row(t);
    if (orientation(piece.points.row(f(0)), piece.points.row(f(1)), piece.points.row(f(2))) <= 0)
      ++flips;
  }
  return flips;
}

/// Share of the weight where `deviation` is within a bound; exactly 0 and 1 for none and all.
double share_within(const Eigen::ArrayXd& deviation, const Eigen::ArrayXd& weights, double bound) {
  double within = 0, all = 0;
  for (Eigen::Index i = 0; i < weights.size(); ++i) {
    all += weights(i);
    if (deviation(i) <= bound) within += weights(i);
  }
  return within / all;
}

/// Largest value of a triangle that carries weight.
double largest_weighted(const Eigen::ArrayXd& values, const Eigen::ArrayXd& weights) {
  return (weights > 0).select(values, 1.0).maxCoeff();
}

}  // namespace

std::vector<FlatPiece> pieces_apart(const Eigen::MatrixX2d& points, const Eigen::MatrixX3d& x,
                                    const Eigen::MatrixX3i& triangles, std::span<const int> piece) {
  if (points.rows() != x.rows() || triangles.rows() != std::ssize(piece)) {
    throw Error(std::to_string(points.rows()) + " points, " + std::to_string(x.rows()) +
                    " places, " + std::to_string(triangles.rows()) + " triangles and " +
                    std::to_string(piece.size()) + " numbers of pieces",
                "flattening", "a place a point and a number a triangle");
  }
  std::map<int, std::vector<Eigen::Index>> triangles_of;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) triangles_of[piece[t]].push_back(t);
  std::vector<FlatPiece> pieces;
  for (const auto& [number, rows] : triangles_of) {
    FlatPiece& flat = pieces.emplace_back();
    std::map<int, int> local;
    flat.triangles.resize(rows.size(), 3);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (int k = 0; k < 3; ++k) {
        const int v = triangles(rows[i], k);
        flat.triangles(i, k) = local.try_emplace(v, static_cast<int>(local.size())).first->second;
      }
    }
    flat.points.resize(local.size(), 2);
    flat.x.resize(local.size(), 3);
    for (const auto& [v, l] : local) {
      flat.points.row(l) = points.row(v);
      flat.x.row(l) = x.row(v);
    }
  }
  return pieces;
}

Eigen::MatrixX2d flattening_singular_values(const FlatPiece& piece) {
  require_piece(piece);
  Eigen::MatrixX3d flat = Eigen::MatrixX3d::Zero(piece.points.rows(), 3);
  flat.leftCols<2>() = piece.points;
  std::vector<int> all(piece.triangles.rows());
  std::iota(all.begin(), all.end(), 0);
  return singular_values(piece.x, flat, piece.triangles, all);
}

FlatteningSummary flattening(std::span<const FlatPiece> pieces) {
  const auto [s, area] = triangles_of_pieces(pieces);
  const double whole = area.sum();
  const Eigen::ArrayXd s1 = s.col(0), s2 = s.col(1);
  const Eigen::ArrayXd stretch = s1.max(s2.inverse()), ratio = s1 * s2, angle = s1 / s2;
  FlatteningSummary f;
  f.stretch_mean = (area * stretch).sum() / whole;
  f.stretch_p95 = weighted_quantile(stretch, area, 0.95);
  f.stretch_max = largest_weighted(stretch, area);
  f.area_ratio = (area * ratio).sum() / whole;
  f.area_ratio_max = (area > 0).select(ratio, 0.0).maxCoeff();
  f.area_ratio_min = (area > 0).select(ratio, f.area_ratio_max).minCoeff();
  f.angle_ratio_mean = (area * angle).sum() / whole;
  f.angle_ratio_max = largest_weighted(angle, area);
  f.sander_l2 =
      std::sqrt((area * (s1.square().inverse() + s2.square().inverse())).sum() / (2 * whole));
  f.sander_linf = (area > 0).select(s2.inverse(), 0.0).maxCoeff();
  for (std::size_t i = 0; i < kFlatteningBounds.size(); ++i) {
    f.stretch_share[i] = share_within(stretch - 1, area, kFlatteningBounds[i]);
    f.area_share[i] = share_within((ratio - 1).abs(), area, kFlatteningBounds[i]);
  }
  for (const FlatPiece& piece : pieces) {
    f.flips += flipped_triangles(piece);
    for (const TrianglePair& pair : overlapping_triangles(piece.points, piece.triangles)) {
      ++f.self_overlaps;
      f.self_overlap_area += pair.area;
    }
  }
  return f;
}

std::vector<PieceOverlap> piece_overlaps(std::span<const FlatPiece> laid_out) {
  Eigen::Index points = 0, triangles = 0;
  for (const FlatPiece& piece : laid_out) {
    points += piece.points.rows();
    triangles += piece.triangles.rows();
  }
  Eigen::MatrixX2d all_points(points, 2);
  Eigen::MatrixX3i all_triangles(triangles, 3);
  std::vector<int> group;
  Eigen::Index at_point = 0, at_triangle = 0;
  for (int i = 0; i < std::ssize(laid_out); ++i) {
    const FlatPiece& piece = laid_out[i];
    all_points.middleRows(at_point, piece.points.rows()) = piece.points;
    all_triangles.middleRows(at_triangle, piece.triangles.rows()) =
        piece.triangles.array() + static_cast<int>(at_point);
    group.insert(group.end(), piece.triangles.rows(), i);
    at_point += piece.points.rows();
    at_triangle += piece.triangles.rows();
  }
  std::map<std::pair<int, int>, double> area;
  for (const TrianglePair& pair : overlapping_triangles(all_points, all_triangles, group))
    area[std::minmax(group[pair.first], group[pair.second])] += pair.area;
  std::vector<PieceOverlap> overlaps;
  for (const auto& [pieces, common] : area)
    overlaps.push_back({pieces.first, pieces.second, common});
  return overlaps;
}

}  // namespace geoprior
