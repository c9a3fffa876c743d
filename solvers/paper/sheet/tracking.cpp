#include "solvers/paper/sheet/tracking.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/angles.h"
#include "core/connectivity.h"
#include "core/geometry/curvature_fit.h"
#include "core/geometry/planar.h"
#include "models/paper/contact/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// Part of all rulings that must be superfluous to be worth a new mesh of their own.
constexpr double kWorthAMesh = 0.25;

int third_vertex(const Eigen::MatrixX3i& triangles, int f, int a, int b) {
  for (int k = 0; k < 3; ++k) {
    if (triangles(f, k) != a && triangles(f, k) != b) return triangles(f, k);
  }
  return -1;
}

/// A ruling beside an end ruling of a cone, as far out as the last one is in.
std::optional<Ruling> beside(const PaperPiece& piece, const Ruling& last, const Ruling* inner,
                             double spacing, const RulingEditor& editor) {
  const bool from_a = last.singular_a == piece.singular_point;
  const Vector2d d = from_a ? Vector2d(last.b - last.a) : Vector2d(last.a - last.b);
  double angle = std::max(spacing / d.norm(), 2 * editor.bounds().least_angle);
  if (inner) {
    const Vector2d other = inner->singular_a == piece.singular_point
                               ? Vector2d(inner->b - inner->a)
                               : Vector2d(inner->a - inner->b);
    if (cross(d, other) > 0) angle = -angle;
  }
  return editor.ray(*piece.singular_point, Eigen::Rotation2Dd(angle) * d);
}

/// A ruling halfway between two of one cone.
std::optional<Ruling> between(const PaperPiece& piece, const Ruling& r, const Ruling& s,
                              const RulingEditor& editor) {
  const auto out = [&](const Ruling& x) {
    return Vector2d((x.singular_a == piece.singular_point ? x.b - x.a : x.a - x.b).normalized());
  };
  return editor.ray(*piece.singular_point, out(r) + out(s));
}

/// Angle that stays open at a singular point when one of its rulings goes.
double opening(const PaperStructure& structure, int singular_point, int ruling,
               const std::vector<bool>& gone) {
  std::vector<double> angles;
  double own = 0;
  for (const int i : structure.rulings_at(singular_point)) {
    if (gone[i]) continue;
    const Ruling& r = structure.rulings[i];
    const Vector2d d = r.singular_a == singular_point ? Vector2d(r.b - r.a) : Vector2d(r.a - r.b);
    const double angle = std::atan2(d.y(), d.x());
    (i == ruling ? own = angle : angles.emplace_back(angle));
  }
  const double full = 2 * std::numbers::pi;
  double ahead = full, behind = full;
  for (const double angle : angles) {
    const double turn = std::fmod(angle - own + 2 * full, full);
    ahead = std::min(ahead, turn);
    behind = std::min(behind, full - turn);
  }
  return ahead + behind;
}

bool is_idle(const Ruling& ruling, const HybridOptions& options) {
  return ruling.unbent_frames >= options.flat_frames;
}

/// Marks the rulings of the cylinders that are flat all over.
std::vector<bool> flat_cylinders(const PaperStructure& structure, const HybridOptions& options) {
  std::vector<bool> bent(structure.pieces.size(), false);
  for (std::size_t i = 0; i < bent.size(); ++i) {
    bent[i] = structure.pieces[i].kind != PaperPiece::Kind::cylinder;
  }
  for (const Ruling& r : structure.rulings) {
    if (r.piece >= 0 && !is_idle(r, options)) bent[r.piece] = true;
  }
  std::vector<bool> marked(structure.rulings.size(), false);
  for (std::size_t i = 0; i < marked.size(); ++i) {
    const int piece = structure.rulings[i].piece;
    marked[i] = piece >= 0 && !bent[piece];
  }
  return marked;
}

/// Marks what is flat of the rulings of singular points, one after another, as long as no more than
/// a right angle stays open.
void mark_idle_rays(const PaperStructure& structure, const HybridOptions& options,
                    std::vector<bool>& gone) {
  for (int i = 0; i < std::ssize(gone); ++i) {
    const Ruling& r = structure.rulings[i];
    if (gone[i] || !is_idle(r, options) || !(r.singular_a || r.singular_b)) continue;
    const auto may_open = [&](const std::optional<int>& point) {
      return !point || opening(structure, *point, i, gone) <= std::numbers::pi / 2;
    };
    gone[i] = may_open(r.singular_a) && may_open(r.singular_b);
  }
}

}  // namespace

std::vector<double> fold_angles(const ShellState& state, const RulingMesh& mesh) {
  const EdgeConnectivity edges(state.mesh.triangles);
  std::vector<double> folds;
  for (const auto& path : mesh.ruling_paths) {
    double sum = 0, length = 0;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) {
      const auto found = edges.find(path[k], path[k + 1]);
      if (!found) continue;
      const int left = edges.left(*found), right = edges.right(*found);
      if (left < 0 || right < 0) continue;
      const auto [a, b] = edges.edge(*found);
      CurvatureFit::Hinge hinge{};
      hinge.a = a;
      hinge.b = b;
      hinge.left = left;
      hinge.right = right;
      hinge.c = third_vertex(state.mesh.triangles, left, a, b);
      hinge.d = third_vertex(state.mesh.triangles, right, a, b);
      const double l = (state.mesh.pattern.row(b) - state.mesh.pattern.row(a)).norm();
      sum += l * dihedral_angle(state.x, hinge);
      length += l;
    }
    folds.push_back(length > 0 ? sum / length : 0);
  }
  return folds;
}

bool refine_rulings(const std::vector<double>& folds, const HybridOptions& options,
                    RulingEditor& editor) {
  const double limit = options.refine_angle_deg * kDegree;
  // Copies: adding rulings moves what the structure holds.
  const std::vector<Ruling> rulings = editor.structure().rulings;
  bool refined = false;
  for (const PaperPiece& piece : std::vector<PaperPiece>(editor.structure().pieces)) {
    if (piece.kind != PaperPiece::Kind::cone) continue;
    const std::size_t n = piece.rulings.size();
    for (std::size_t k = 0; k < n; ++k) {
      const auto index = [&](std::size_t at) {
        return static_cast<std::size_t>(piece.rulings[at]);
      };
      if (std::abs(folds[index(k)]) < limit) continue;
      for (const int side : {-1, 1}) {
        const bool end = side < 0 ? k == 0 : k + 1 == n;
        const std::size_t next = side < 0 ? k - 1 : k + 1;
        const std::size_t inner = side < 0 ? k + 1 : k - 1;
        const Ruling* within = inner < n ? &rulings[index(inner)] : nullptr;
        const auto ruling =
            end ? beside(piece, rulings[index(k)], within, options.seeding_distance, editor)
                : between(piece, rulings[index(k)], rulings[index(next)], editor);
        if (!ruling) continue;
        editor.add(*ruling);
        refined = true;
      }
    }
  }
  return refined;
}

void count_flat_frames(const std::vector<double>& folds, const HybridOptions& options,
                       RulingEditor& editor) {
  PaperStructure& structure = editor.structure();
  const double flat = options.flat_curvature * options.seeding_distance;
  const double sharp = options.refine_angle_deg * kDegree;
  for (std::size_t i = 0; i < folds.size(); ++i) {
    int& frames = structure.rulings[i].unbent_frames;
    frames = std::abs(folds[i]) < flat ? frames + 1 : 0;
  }
  for (const PaperPiece& piece : structure.pieces) {
    for (std::size_t k = 0; k < piece.rulings.size(); ++k) {
      if (std::abs(folds[piece.rulings[k]]) < sharp) continue;
      for (const std::size_t beside : {k - 1, k + 1}) {
        if (beside >= piece.rulings.size()) continue;
        structure.rulings[piece.rulings[beside]].unbent_frames = 0;
      }
    }
  }
}

bool retire_rulings(bool remeshed_anyway, const HybridOptions& options, RulingEditor& editor) {
  const PaperStructure& structure = editor.structure();
  std::vector<bool> gone = flat_cylinders(structure, options);
  mark_idle_rays(structure, options, gone);
  const auto count = std::count(gone.begin(), gone.end(), true);
  const double least = remeshed_anyway ? 1 : kWorthAMesh * static_cast<double>(gone.size());
  if (count == 0 || static_cast<double>(count) < least) return false;
  editor.remove(gone);
  return true;
}

}  // namespace geoprior::paper
