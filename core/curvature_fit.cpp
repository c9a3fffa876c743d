#include "core/curvature_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>

#include "core/error.h"

namespace geoprior {
namespace {

using Hinge = CurvatureFit::Hinge;
using Rows3 = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, CurvatureFit::kMostTerms, 3>;
using Columns3 = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, CurvatureFit::kMostTerms>;

/// Smallest ratio of singular values at which a direction of S counts as observed, for rows of unit
/// length in the affine frame of the patch. The inverse multiplies by up to its reciprocal what the
/// fit cannot represent, the variation of S over the patch: fans about an apex, whose edges all see
/// nearly the same combination of S, lock when it is small. On random Delaunay meshes the patches
/// of a triangle and its neighbours stay above it (3,200 triangles).
constexpr double kObserved = 0.2;
/// Weight of an edge `distance` triangles away, as a factor on its row: the fit belongs to the
/// triangle.
double distance_weight(int distance) { return 1.0 / (1 + distance); }

// Symmetric matrices as (uu, sqrt2 uv, vv): Frobenius products are dot products.
const double kRoot2 = std::numbers::sqrt2;

Eigen::Vector3d mandel(const Eigen::Matrix2d& S) {
  return {S(0, 0), kRoot2 / 2 * (S(0, 1) + S(1, 0)), S(1, 1)};
}

Eigen::Matrix2d from_mandel(const Eigen::Vector3d& m) {
  Eigen::Matrix2d S;
  S << m[0], m[1] / kRoot2, m[1] / kRoot2, m[2];
  return S;
}

/// Matrix of S -> K' S K.
Eigen::Matrix3d congruence(const Eigen::Matrix2d& K) {
  Eigen::Matrix3d T;
  for (int i = 0; i < 3; ++i)
    T.col(i) = mandel(K.transpose() * from_mandel(Eigen::Vector3d::Unit(i)) * K);
  return T;
}

/// Jump of slope per unit of S_uu, S_uv, S_vv. With s along the edge of length L and t to its left,
/// c = (cs, ct) and d = (ds, -dt):
///   1/2 k_ss [(cs^2 - cs L)/ct + (ds^2 - ds L)/dt] + k_st (cs - ds) + 1/2 k_tt (ct + dt).
Eigen::Vector3d slope_jump(const Eigen::MatrixX2d& pattern, const Hinge& h) {
  const Eigen::Vector2d origin = pattern.row(h.a);
  const Eigen::Vector2d edge = pattern.row(h.b).transpose() - origin;
  const double L = edge.norm();
  const Eigen::Vector2d s = edge / L, t(-s.y(), s.x());
  const Eigen::Vector2d c = pattern.row(h.c).transpose() - origin;
  const Eigen::Vector2d d = pattern.row(h.d).transpose() - origin;
  const double cs = c.dot(s), ct = c.dot(t), ds = d.dot(s), dt = -d.dot(t);
  const double ss = 0.5 * (cs * (cs - L) / ct + ds * (ds - L) / dt);
  const double st = cs - ds, tt = 0.5 * (ct + dt);
  return {ss * s.x() * s.x() + st * s.x() * t.x() + tt * t.x() * t.x(),
          2 * ss * s.x() * s.y() + st * (s.x() * t.y() + s.y() * t.x()) + 2 * tt * t.x() * t.y(),
          ss * s.y() * s.y() + st * s.y() * t.y() + tt * t.y() * t.y()};
}

std::vector<double> pattern_areas(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& F) {
  std::vector<double> area(static_cast<std::size_t>(F.rows()));
  for (Eigen::Index t = 0; t < F.rows(); ++t) {
    const Eigen::RowVector2d p = pattern.row(F(t, 0));
    const Eigen::RowVector2d e = pattern.row(F(t, 1)) - p, f = pattern.row(F(t, 2)) - p;
    const double twice = e.x() * f.y() - e.y() * f.x();
    const double longest =
        std::max({e.squaredNorm(), f.squaredNorm(), (f - e).eval().squaredNorm()});
    if (!(twice > 1e-12 * longest))
      throw Error(twice < 0 ? "triangle turned over in the pattern"
                            : "triangle without area in the pattern",
                  "triangle " + std::to_string(t), "counter-clockwise triangles");
    area[static_cast<std::size_t>(t)] = twice / 2;
  }
  return area;
}

/// Interior edges in the order of the triangles that have them first; `of_triangle` gets the
/// hinge at each triangle's three edges (-1: border).
std::vector<Hinge> find_hinges(const Eigen::MatrixX3i& F,
                               std::vector<std::array<int, 3>>& of_triangle) {
  struct Side {
    int low, high, triangle, corner;
  };
  std::vector<Side> sides;
  sides.reserve(static_cast<std::size_t>(3 * F.rows()));
  for (int t = 0; t < static_cast<int>(F.rows()); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(F(t, k), F(t, (k + 1) % 3));
      sides.push_back({low, high, t, k});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& p, const Side& q) {
    return std::tie(p.low, p.high, p.triangle) < std::tie(q.low, q.high, q.triangle);
  });
  std::vector<std::array<int, 3>> other(static_cast<std::size_t>(F.rows()), {-1, -1, -1});
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high)
      ++end;
    const Side &p = sides[i], &q = sides[end - 1];
    if (end - i > 2 || (end - i == 2 && F(p.triangle, p.corner) == F(q.triangle, q.corner)))
      throw Error("edge that is not manifold",
                  "edge " + std::to_string(p.low) + "-" + std::to_string(p.high),
                  "one or two triangles of opposite direction at an edge");
    if (end - i == 2) {
      other[static_cast<std::size_t>(p.triangle)][static_cast<std::size_t>(p.corner)] =
          3 * q.triangle + q.corner;
      other[static_cast<std::size_t>(q.triangle)][static_cast<std::size_t>(q.corner)] =
          3 * p.triangle + p.corner;
    }
    i = end;
  }
  std::vector<Hinge> hinges;
  of_triangle.assign(static_cast<std::size_t>(F.rows()), {-1, -1, -1});
  for (int t = 0; t < static_cast<int>(F.rows()); ++t)
    for (int k = 0; k < 3; ++k) {
      const int opposite = other[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)];
      if (opposite < 0 || opposite / 3 < t) continue;
      const int right = opposite / 3, corner = opposite % 3;
      const int index = static_cast<int>(hinges.size());
      of_triangle[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)] = index;
      of_triangle[static_cast<std::size_t>(right)][static_cast<std::size_t>(corner)] = index;
      hinges.push_back({F(t, k), F(t, (k + 1) % 3), t, right, F(t, (k + 2) % 3),
                        F(right, (corner + 2) % 3), Eigen::Vector3d::Zero()});
    }
  return hinges;
}

/// The edges within reach of a triangle, ring by ring.
class Patch {
 public:
  Patch(const std::vector<Hinge>& hinges, const std::vector<std::array<int, 3>>& of_triangle,
        int triangle)
      : hinges_(&hinges), of_triangle_(&of_triangle), triangles_{triangle} {}

  /// Adds the edges of the outermost triangles; those across them become the outermost.
  void grow() {
    const std::size_t last = triangles_.size();
    for (; next_ < last; ++next_)
      for (const int h : (*of_triangle_)[static_cast<std::size_t>(triangles_[next_])]) add(h);
    ++rings_;
  }
  [[nodiscard]] const std::vector<int>& edges() const { return edges_; }
  [[nodiscard]] const std::vector<int>& vertices() const { return vertices_; }
  [[nodiscard]] const std::vector<int>& distance() const { return distance_; }

 private:
  void add(int index) {
    if (index < 0 || std::find(edges_.begin(), edges_.end(), index) != edges_.end()) return;
    const Hinge& h = (*hinges_)[static_cast<std::size_t>(index)];
    std::vector<int> vertices = vertices_;
    for (const int v : {h.a, h.b, h.c, h.d})
      if (std::find(vertices.begin(), vertices.end(), v) == vertices.end()) vertices.push_back(v);
    if (vertices.size() > CurvatureFit::kMostVertices || edges_.size() == CurvatureFit::kMostTerms)
      return;
    vertices_ = vertices;
    edges_.push_back(index);
    distance_.push_back(rings_);
    for (const int t : {h.left, h.right})
      if (std::find(triangles_.begin(), triangles_.end(), t) == triangles_.end())
        triangles_.push_back(t);
  }

  const std::vector<Hinge>* hinges_;
  const std::vector<std::array<int, 3>>* of_triangle_;
  std::vector<int> triangles_, edges_, distance_, vertices_;
  std::size_t next_ = 0;
  int rings_ = 0;
};

/// Matrix from S in the affine frame of a patch, where its vertices spread alike in all directions,
/// to S in the pattern. There the rank does not depend on stretch: six points on a conic stay so.
Eigen::Matrix3d affine_frame(const Eigen::MatrixX2d& pattern, const Patch& patch) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const int v : patch.vertices()) mean += pattern.row(v);
  mean /= static_cast<double>(patch.vertices().size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const int v : patch.vertices()) {
    const Eigen::Vector2d p = pattern.row(v).transpose() - mean;
    spread += p * p.transpose();
  }
  return congruence(spread.llt().matrixL().toDenseMatrix().inverse());
}

/// Jump at edge i of a patch, to be multiplied with S as (uu, sqrt2 uv, vv).
Eigen::Vector3d mandel_jump(const std::vector<Hinge>& hinges, const Patch& patch, Eigen::Index i) {
  const int edge = patch.edges()[static_cast<std::size_t>(i)];
  const Eigen::Vector3d& jump = hinges[static_cast<std::size_t>(edge)].jump;
  return {jump[0], jump[1] / kRoot2, jump[2]};
}

/// Directions of S that the edges of a patch observe.
struct Observation {
  Eigen::Matrix3d from_affine;
  Rows3 rows;  ///< jumps in the affine frame
  int rank = 0;
};

Observation observe(const Eigen::MatrixX2d& pattern, const std::vector<Hinge>& hinges,
                    const Patch& patch) {
  Observation seen;
  const auto n = static_cast<Eigen::Index>(patch.edges().size());
  seen.rows.resize(n, 3);
  if (n == 0) return seen;
  seen.from_affine = affine_frame(pattern, patch);
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < n; ++i) {
    seen.rows.row(i) = mandel_jump(hinges, patch, i).transpose() * seen.from_affine;
    gram += seen.rows.row(i).normalized().transpose() * seen.rows.row(i).normalized();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(gram, Eigen::EigenvaluesOnly);
  for (int i = 0; i < 3; ++i)
    seen.rank += eigen.eigenvalues()[i] > kObserved * kObserved * eigen.eigenvalues()[2];
  return seen;
}

/// Coefficients (3 x edges, Mandel) of the weighted least-squares fit where all of S is observed.
Columns3 fitted(const std::vector<Hinge>& hinges, const Patch& patch, const Observation& seen) {
  const Eigen::Index n = seen.rows.rows();
  Eigen::VectorXd weight(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    weight[i] = distance_weight(patch.distance()[k]) / mandel_jump(hinges, patch, i).norm();
  }
  const Eigen::MatrixXd weighted = weight.asDiagonal() * seen.rows;
  return seen.from_affine * Eigen::HouseholderQR<Eigen::MatrixXd>(weighted).solve(
                                Eigen::MatrixXd(weight.asDiagonal()));
}

/// Coefficients (3 x edges, Mandel) of folds: each angle is spread over half the heights of the two
/// triangles at its edge, as curvature across the edge.
Columns3 folds(const Eigen::MatrixX2d& pattern, const std::vector<Hinge>& hinges,
               const Patch& patch) {
  Columns3 coefficients(3, static_cast<Eigen::Index>(patch.edges().size()));
  for (Eigen::Index i = 0; i < coefficients.cols(); ++i) {
    const Hinge& h = hinges[static_cast<std::size_t>(patch.edges()[static_cast<std::size_t>(i)])];
    const Eigen::Vector2d edge = (pattern.row(h.b) - pattern.row(h.a)).normalized();
    const Eigen::Vector2d across(-edge.y(), edge.x());
    const Eigen::Vector3d fold = mandel(across * across.transpose());
    coefficients.col(i) = fold / mandel_jump(hinges, patch, i).dot(fold);
  }
  return coefficients;
}

}  // namespace

CurvatureFit fit_curvature(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& triangles) {
  CurvatureFit fit;
  fit.area = pattern_areas(pattern, triangles);
  std::vector<std::array<int, 3>> of_triangle;
  fit.hinges = find_hinges(triangles, of_triangle);
  for (Hinge& h : fit.hinges) h.jump = slope_jump(pattern, h);
  const std::size_t m = fit.area.size();
  fit.terms.resize(m);
  fit.own.resize(m);
  fit.rank.resize(m);
  for (std::size_t t = 0; t < m; ++t) {
    Patch patch(fit.hinges, of_triangle, static_cast<int>(t));
    patch.grow();
    fit.own[t] = static_cast<int>(patch.edges().size());
    Observation seen = observe(pattern, fit.hinges, patch);
    Patch wider = patch;
    for (int ring = 1; ring <= 2 && seen.rank < 3; ++ring) {
      wider.grow();
      const Observation more = observe(pattern, fit.hinges, wider);
      // The one edge of the triangle at the end of a strip is a diagonal: it needs the ruling too.
      if (more.rank == 3 || (fit.own[t] == 1 && ring == 1)) {
        seen = more;
        patch = wider;
      }
    }
    fit.rank[t] = seen.rank;
    const Columns3 coefficients =
        seen.rank == 3 ? fitted(fit.hinges, patch, seen) : folds(pattern, fit.hinges, patch);
    for (std::size_t i = 0; i < patch.edges().size(); ++i) {
      Eigen::Vector3d c = coefficients.col(static_cast<Eigen::Index>(i));
      c[1] /= kRoot2;
      fit.terms[t].push_back({patch.edges()[i], c});
    }
  }
  return fit;
}

double dihedral_angle(const Eigen::MatrixX3d& x, const CurvatureFit::Hinge& hinge) {
  const Eigen::Vector3d a = x.row(hinge.a), b = x.row(hinge.b), c = x.row(hinge.c),
                        d = x.row(hinge.d);
  const Eigen::Vector3d e = b - a, ad = d - a;
  const Eigen::Vector3d left = e.cross(c - a), right = ad.cross(e);
  // right x left = (ad x e) x left = e (ad . left).
  return std::atan2(ad.dot(left) * e.norm(), left.dot(right));
}

Eigen::MatrixX3d shape_operators(const CurvatureFit& fit, const Eigen::MatrixX3d& x) {
  std::vector<double> angle;
  angle.reserve(fit.hinges.size());
  for (const Hinge& h : fit.hinges) angle.push_back(dihedral_angle(x, h));
  Eigen::MatrixX3d S = Eigen::MatrixX3d::Zero(static_cast<Eigen::Index>(fit.terms.size()), 3);
  for (std::size_t t = 0; t < fit.terms.size(); ++t)
    for (const CurvatureFit::Term& term : fit.terms[t])
      S.row(static_cast<Eigen::Index>(t)) +=
          term.coefficient.transpose() * angle[static_cast<std::size_t>(term.hinge)];
  return S;
}

}  // namespace geoprior
