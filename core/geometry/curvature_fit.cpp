#include "core/geometry/curvature_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "core/connectivity.h"
#include "core/error.h"
#include "core/geometry/curvature_estimate.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

using Hinge = CurvatureFit::Hinge;
using Terms = std::vector<CurvatureFit::Term>;  // here with coefficients as (uu, sqrt2 uv, vv)

constexpr std::size_t kBlock = 64;  // triangles fitted by one thread: about 0.1 ms

/// Slope across the edge a-b of the plane through a, b, c less that of the quadratic u' S u / 2 at
/// the middle of the edge, per unit of S as (uu, sqrt2 uv, vv). With s along the edge of length L,
/// t to its left and c = (cs, ct):
///   1/2 k_ss cs (cs - L)/ct + k_st (cs - L/2) + 1/2 k_tt ct.
Eigen::Vector3d slope_rise(const Eigen::MatrixX2d& pattern, int a, int b, int c) {
  const Eigen::Vector2d edge = pattern.row(b) - pattern.row(a);
  const double L = edge.norm();
  const Eigen::Vector2d s = edge / L, t(-s.y(), s.x());
  const Eigen::Vector2d p = pattern.row(c) - pattern.row(a);
  const double cs = p.dot(s), ct = p.dot(t);
  return mandel(0.5 * cs * (cs - L) / ct * s * s.transpose() + (cs - L / 2) * s * t.transpose() +
                0.5 * ct * t * t.transpose());
}

std::vector<double> pattern_areas(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& F) {
  std::vector<double> area(F.rows());
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
    area[t] = twice / 2;
  }
  return area;
}

/// Interior edges in the order of the triangles that have them first; `of_triangle` gets the
/// hinge at each triangle's three edges (-1: border).
std::vector<Hinge> find_hinges(const Eigen::MatrixX3i& F,
                               std::vector<std::array<int, 3>>& of_triangle) {
  const EdgeConnectivity connectivity(F);
  if (const auto h = connectivity.first_repeated()) {
    const Edge& edge = connectivity.edge(connectivity.edge_of(*h));
    throw Error("edge that is not manifold",
                "edge " + std::to_string(edge[0]) + "-" + std::to_string(edge[1]),
                "one or two triangles of opposite direction at an edge");
  }
  std::vector<Hinge> hinges;
  of_triangle.assign(F.rows(), {-1, -1, -1});
  for (int t = 0; t < F.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const int opposite = connectivity.twin(3 * t + k);
      if (opposite < 0 || opposite / 3 < t) continue;
      const int right = opposite / 3, corner = opposite % 3;
      const int index = static_cast<int>(hinges.size());
      of_triangle[t][k] = index;
      of_triangle[right][corner] = index;
      hinges.push_back({F(t, k), F(t, (k + 1) % 3), t, right, F(t, (k + 2) % 3),
                        F(right, (corner + 2) % 3), Eigen::Vector3d::Zero()});
    }
  return hinges;
}

/// Turns estimates of S into shape operators whose constant moments are in equilibrium.
struct Assembly {
  const Eigen::MatrixX2d& pattern;
  const Eigen::MatrixX3i& triangles;
  const CurvatureFit& fit;
  const std::vector<std::array<int, 3>>& of_triangle;
  const std::vector<CurvatureEstimate>& estimates;

  [[nodiscard]] Terms terms(int triangle) const {
    const std::size_t t = triangle;
    if (fit.rank[t] < 3) return estimates[t].terms;
    Terms sum;
    sum.reserve(CurvatureFit::kMostTerms);
    // Own edges first.
    for (const int h : of_triangle[t])
      if (h >= 0) add(sum, h, Eigen::Vector3d::Zero());
    for (int k = 0; k < 3; ++k) add_edge(sum, triangle, k);
    return fits(sum) ? sum : estimates[t].terms;
  }

 private:
  static void add(Terms& sum, int hinge, const Eigen::Vector3d& coefficient) {
    for (CurvatureFit::Term& term : sum)
      if (term.hinge == hinge) {
        term.coefficient += coefficient;
        return;
      }
    sum.push_back({hinge, coefficient});
  }

  /// l alpha n n' / A of one edge.
  void add_edge(Terms& sum, int triangle, int k) const {
    const std::size_t t = triangle;
    const int a = triangles(triangle, k), b = triangles(triangle, (k + 1) % 3);
    const Eigen::Vector2d edge = pattern.row(b) - pattern.row(a);
    const Eigen::Vector2d normal(-edge.y(), edge.x());
    const Eigen::Vector3d dyad = mandel(normal * normal.transpose()) / (edge.norm() * fit.area[t]);
    const int index = of_triangle[t][k];
    if (index < 0) {
      const Eigen::Vector3d rise = slope_rise(pattern, a, b, triangles(triangle, (k + 2) % 3));
      for (const auto& term : estimates[t].terms)
        add(sum, term.hinge, dyad * rise.dot(term.coefficient));
      return;
    }
    const Hinge& h = fit.hinges[index];
    add(sum, index, dyad / 2);
    const Eigen::Vector3d beta =
        (slope_rise(pattern, h.a, h.b, h.c) - slope_rise(pattern, h.b, h.a, h.d)) / 2;
    if (beta.norm() < 1e-9 * edge.norm()) return;  // the edge's two triangles are point symmetric
    const auto [first, second] = sources_of(h);
    const double share = (h.left == triangle ? 1.0 : -1.0) / (first == second ? 1 : 2);
    const auto add_source = [&](int source) {
      for (const auto& term : estimates[source].terms)
        add(sum, term.hinge, dyad * (share * beta.dot(term.coefficient)));
    };
    add_source(first);
    if (second != first) add_source(second);
  }

  /// Triangles whose estimates stand for S at an edge: both if they see their own edges
  /// only, else the one of the smaller reach, twice.
  [[nodiscard]] std::array<int, 2> sources_of(const Hinge& h) const {
    const auto reach = [&](int t) {
      const CurvatureEstimate& e = estimates[t];
      if (e.rank < 3) return 100;
      return e.terms.size() == 3 && fit.own[t] == 3 ? 0 : static_cast<int>(e.terms.size());
    };
    const int left = reach(h.left), right = reach(h.right);
    if (left == 0 && right == 0) return {h.left, h.right};
    const int nearer = left <= right ? h.left : h.right;
    return {nearer, nearer};
  }

  [[nodiscard]] bool fits(const Terms& sum) const {
    std::array<int, CurvatureFit::kMostVertices> vertices{};
    auto end = vertices.begin();
    for (const auto& term : sum) {
      const Hinge& h = fit.hinges[term.hinge];
      for (const int v : {h.a, h.b, h.c, h.d}) {
        if (std::find(vertices.begin(), end, v) != end) continue;
        if (end == vertices.end()) return false;
        *end++ = v;
      }
    }
    return sum.size() <= CurvatureFit::kMostTerms;
  }
};

}  // namespace

CurvatureFit fit_curvature(const Eigen::MatrixX2d& pattern, const Eigen::MatrixX3i& triangles) {
  CurvatureFit fit;
  fit.area = pattern_areas(pattern, triangles);
  std::vector<std::array<int, 3>> of_triangle;
  fit.hinges = find_hinges(triangles, of_triangle);
  for (Hinge& h : fit.hinges) {
    h.jump = slope_rise(pattern, h.a, h.b, h.c) + slope_rise(pattern, h.b, h.a, h.d);
    h.jump[1] *= std::numbers::sqrt2;
  }
  const std::size_t m = fit.area.size();
  fit.own.resize(m);
  fit.rank.resize(m);
  std::vector<CurvatureEstimate> estimates(m);
  parallel_blocks(m, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      estimates[t] = estimate_curvature(pattern, fit.hinges, of_triangle, static_cast<int>(t));
      fit.rank[t] = estimates[t].rank;
      fit.own[t] = static_cast<int>(std::count_if(of_triangle[t].begin(), of_triangle[t].end(),
                                                  [](int h) { return h >= 0; }));
    }
  });
  fit.terms.resize(m);
  const Assembly assembly{pattern, triangles, fit, of_triangle, estimates};
  parallel_blocks(m, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      fit.terms[t] = assembly.terms(static_cast<int>(t));
      for (CurvatureFit::Term& term : fit.terms[t]) term.coefficient[1] /= std::numbers::sqrt2;
    }
  });
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
  Eigen::MatrixX3d S = Eigen::MatrixX3d::Zero(fit.terms.size(), 3);
  for (std::size_t t = 0; t < fit.terms.size(); ++t)
    for (const CurvatureFit::Term& term : fit.terms[t])
      S.row(t) += term.coefficient.transpose() * angle[term.hinge];
  return S;
}

}  // namespace geoprior
