#include "core/geometry/curvature_estimate.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace geoprior {
namespace {

using Hinge = CurvatureHinge;
/// Smallest ratio of singular values at which a direction of S counts as observed, for rows of unit
/// length in the affine frame of the patch. The inverse multiplies by up to its reciprocal what the
/// fit cannot represent, the variation of S over the patch: fans about an apex, whose edges all see
/// nearly the same combination of S, lock when it is small. On random Delaunay meshes the patches
/// of a triangle and its neighbours stay above it (3,200 triangles).
constexpr double kObserved = 0.2;
/// Most edges and vertices of an estimate.
constexpr int kMostEdges = 12;
/// Weight of an edge `distance` triangles away, as a factor on its row: the fit belongs to the
/// triangle.
double distance_weight(int distance) { return 1.0 / (1 + distance); }

using Rows3 = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMostEdges, 3>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostEdges, kMostEdges>;
using Columns3 = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, kMostEdges>;

constexpr double kRoot2 = std::numbers::sqrt2;

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

/// A few items in place: patches are built for every triangle whenever a mesh changes.
class Few {
 public:
  Few() = default;
  explicit Few(int item) { push_back(item); }
  void push_back(int item) { items_[size_++] = item; }
  [[nodiscard]] bool has(int item) const { return std::find(begin(), end(), item) != end(); }
  [[nodiscard]] std::size_t size() const { return size_; }
  int operator[](std::size_t i) const { return items_[i]; }
  [[nodiscard]] const int* begin() const { return items_.data(); }
  [[nodiscard]] const int* end() const { return items_.data() + size_; }

 private:
  std::array<int, kMostEdges + 4> items_{};  // a patch may look one edge too far: 4 vertices more
  std::size_t size_ = 0;
};

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
      for (const int h : (*of_triangle_)[triangles_[next_]]) add(h);
    ++rings_;
  }
  [[nodiscard]] const Few& edges() const { return edges_; }
  [[nodiscard]] const Few& vertices() const { return vertices_; }
  [[nodiscard]] const Few& distance() const { return distance_; }

 private:
  void add(int index) {
    if (index < 0 || edges_.has(index)) return;
    const Hinge& h = (*hinges_)[index];
    Few vertices = vertices_;
    for (const int v : {h.a, h.b, h.c, h.d})
      if (!vertices.has(v)) vertices.push_back(v);
    if (vertices.size() > std::size_t{kMostEdges} || edges_.size() == std::size_t{kMostEdges})
      return;
    vertices_ = vertices;
    edges_.push_back(index);
    distance_.push_back(rings_);
    for (const int t : {h.left, h.right})
      if (!triangles_.has(t)) triangles_.push_back(t);
  }

  const std::vector<Hinge>* hinges_;
  const std::vector<std::array<int, 3>>* of_triangle_;
  Few triangles_, edges_, distance_, vertices_;
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
  const int edge = patch.edges()[i];
  const Eigen::Vector3d& jump = hinges[edge].jump;
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
  const Eigen::Index n = patch.edges().size();
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
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostEdges, 1> weight(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    weight[i] = distance_weight(patch.distance()[i]) / mandel_jump(hinges, patch, i).norm();
  }
  const Rows3 weighted = weight.asDiagonal() * seen.rows;
  const Square right = weight.asDiagonal();
  return seen.from_affine * Eigen::HouseholderQR<Rows3>(weighted).solve(right);
}

/// Coefficients (3 x edges, Mandel) of folds: each angle is spread over half the heights of the two
/// triangles at its edge, as curvature across the edge.
Columns3 folds(const Eigen::MatrixX2d& pattern, const std::vector<Hinge>& hinges,
               const Patch& patch) {
  Columns3 coefficients(3, patch.edges().size());
  for (Eigen::Index i = 0; i < coefficients.cols(); ++i) {
    const Hinge& h = hinges[patch.edges()[i]];
    const Eigen::Vector2d edge = (pattern.row(h.b) - pattern.row(h.a)).normalized();
    const Eigen::Vector2d across(-edge.y(), edge.x());
    const Eigen::Vector3d fold = mandel(across * across.transpose());
    coefficients.col(i) = fold / mandel_jump(hinges, patch, i).dot(fold);
  }
  return coefficients;
}

}  // namespace

Eigen::Vector3d mandel(const Eigen::Matrix2d& S) {
  return {S(0, 0), kRoot2 / 2 * (S(0, 1) + S(1, 0)), S(1, 1)};
}

CurvatureEstimate estimate_curvature(const Eigen::MatrixX2d& pattern,
                                     const std::vector<Hinge>& hinges,
                                     const std::vector<std::array<int, 3>>& of_triangle,
                                     int triangle) {
  Patch patch(hinges, of_triangle, triangle);
  patch.grow();
  const std::size_t own = patch.edges().size();
  Observation seen = observe(pattern, hinges, patch);
  Patch wider = patch;
  for (int ring = 1; ring <= 2 && seen.rank < 3; ++ring) {
    wider.grow();
    const Observation more = observe(pattern, hinges, wider);
    // The one edge of the triangle at the end of a strip is a diagonal: it needs the ruling too.
    if (more.rank == 3 || (own == 1 && ring == 1)) {
      seen = more;
      patch = wider;
    }
  }
  const Columns3 coefficients =
      seen.rank == 3 ? fitted(hinges, patch, seen) : folds(pattern, hinges, patch);
  CurvatureEstimate result;
  result.rank = seen.rank;
  result.terms.reserve(patch.edges().size());
  for (std::size_t i = 0; i < patch.edges().size(); ++i)
    result.terms.push_back({patch.edges()[i], coefficients.col(i)});
  return result;
}

}  // namespace geoprior
