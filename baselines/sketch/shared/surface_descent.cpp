#include "baselines/sketch/shared/surface_descent.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include "core/angles.h"
#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/parallel.h"
#include "models/sketch/surface/cotangent_weights.h"

namespace geoprior::sketch {
namespace {

/// Part of the fall that the slope promises and a step must reach.
constexpr double kArmijo = 1e-4;
/// A direction is given up when even this part of it does not lead down.
constexpr double kShortestPart = 1e-6;
/// Longest move of a vertex in a step, in mean edge lengths; largest turn of a triangle's normal; a
/// triangle with a smaller angle than the last does not get thinner. The guard is ours.
constexpr double kLargestMove = 0.3;
constexpr double kLargestTurn = 45 * kDegree;
constexpr double kThinAngle = 1 * kDegree;
/// Vertices of triangles that get too thin are held; this many times over, since holding them bends
/// the triangles around.
constexpr int kRoundsOfHolding = 8;
constexpr std::size_t kGuardedTogether = 1024;
constexpr std::array<std::string_view, 3> kMetricNames{"flat", "laplacian", "bilaplacian"};

/// Twice the area of a triangle, along its normal.
Eigen::RowVector3d twice_area(const Eigen::MatrixX3i& F, Eigen::Index t,
                              const Eigen::MatrixX3d& x) {
  const Eigen::RowVector3d first = x.row(F(t, 0));
  return (x.row(F(t, 1)) - first).cross(x.row(F(t, 2)) - first);
}

/// Sine of the smallest angle of a triangle: the one between its two longest edges.
double smallest_sine(const Eigen::MatrixX3i& F, Eigen::Index t, const Eigen::MatrixX3d& x) {
  const double a = (x.row(F(t, 0)) - x.row(F(t, 1))).squaredNorm();
  const double b = (x.row(F(t, 1)) - x.row(F(t, 2))).squaredNorm();
  const double c = (x.row(F(t, 2)) - x.row(F(t, 0))).squaredNorm();
  const double longest = std::max({a, b, c}), shortest = std::min({a, b, c});
  const double middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
  return shortest > 0 ? twice_area(F, t, x).norm() / std::sqrt(longest * middle) : 0;
}

Eigen::VectorXd thirds_of_areas(const TriMesh& mesh) {
  const Eigen::VectorXd areas = triangle_areas(mesh.V, mesh.F);
  Eigen::VectorXd at_vertex = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Eigen::Index t = 0; t < areas.size(); ++t) {
    if (!(areas(t) > 0))
      throw Error("its area is zero", "triangle " + std::to_string(t), "triangles of finite size");
    for (int k = 0; k < 3; ++k) at_vertex(mesh.F(t, k)) += areas(t) / 3;
  }
  return at_vertex;
}

double mean_edge_length(const TriMesh& mesh) {
  double sum = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      sum += (mesh.V.row(mesh.F(t, k)) - mesh.V.row(mesh.F(t, (k + 1) % 3))).norm();
  return sum / static_cast<double>(std::max<Eigen::Index>(1, 3 * mesh.F.rows()));
}

}  // namespace

void describe(OptionVisitor& v, DescentOptions& options) {
  v.value("memory", options.memory,
          {.doc = "steps that L-BFGS remembers; 0: preconditioned gradient", .min = 0, .max = 100});
  describe_choice(v, "metric", options.metric, kMetricNames,
                  {.doc = "what a gradient is divided by: nothing, K, or K M^-1 K"});
  v.value("fixed_border", options.fixed_border, {.doc = "whether vertices of the border stay"});
}

SurfaceDescent::SurfaceDescent(const TriMesh& mesh, PositionEnergy energy,
                               const DescentOptions& options)
    : mesh_(mesh),
      function_(std::move(energy)),
      options_(options),
      fixed_(mesh.vertex_count(), false),
      lbfgs_(options.memory) {
  if (options.fixed_border) fixed_ = boundary_vertices(mesh.F, mesh.vertex_count());
  area_ = thirds_of_areas(mesh);
  for (Eigen::Index v = 0; v < area_.size(); ++v) {
    if (area_(v) > 0) continue;
    fixed_[v] = true;  // it has no triangles
    area_(v) = 1;
  }
  mean_edge_ = mean_edge_length(mesh);
  if (options.metric != DescentMetric::flat) build_metric();
  value_ = evaluate(mesh_.V, gradient_);
}

void SurfaceDescent::build_metric() {
  Eigen::SparseMatrix<double> matrix =
      cotangent_stiffness(mesh_.F, corner_cotangents(mesh_), mesh_.vertex_count());
  matrix.prune(
      [&](Eigen::Index i, Eigen::Index j, double) { return i == j || (!fixed_[i] && !fixed_[j]); });
  const double diagonal = bounding_box_diagonal(mesh_.V);
  for (int v = 0; v < mesh_.vertex_count(); ++v)
    matrix.coeffRef(v, v) = fixed_[v] ? 1 : matrix.coeff(v, v) + area_(v) / (diagonal * diagonal);
  cholesky_.emplace(matrix, "metric of a descent");
}

void SurfaceDescent::precondition(Eigen::MatrixX3d& values) const {
  if (options_.metric == DescentMetric::flat) return;
  cholesky_->solve(values);
  if (options_.metric == DescentMetric::laplacian) return;
  values.array().colwise() *= area_.array();
  cholesky_->solve(values);
}

double SurfaceDescent::evaluate(const Eigen::MatrixX3d& x, Eigen::MatrixX3d& gradient) {
  ++evaluations_;
  const double value = function_(x, &gradient);
  for (Eigen::Index v = 0; v < gradient.rows(); ++v)
    if (fixed_[v]) gradient.row(v).setZero();
  return value;
}

bool SurfaceDescent::turns_too_far(const Eigen::MatrixX3d& x) const {
  const double least = std::cos(kLargestTurn);
  std::atomic<bool> too_far = false;
  parallel_blocks(mesh_.F.rows(), kGuardedTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Index t = i;
      const Eigen::RowVector3d now = twice_area(mesh_.F, t, mesh_.V);
      const Eigen::RowVector3d then = twice_area(mesh_.F, t, x);
      if (!(now.dot(then) >= least * now.norm() * then.norm())) too_far = true;
    }
  });
  return too_far;
}

bool SurfaceDescent::hold_thin(const Eigen::MatrixX3d& x, Eigen::MatrixX3d& direction) const {
  const double thin = std::sin(kThinAngle);
  std::vector<char> offends(mesh_.F.rows(), 0);
  parallel_blocks(offends.size(), kGuardedTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Index t = i;
      const double then = smallest_sine(mesh_.F, t, x);
      offends[i] = !(then >= thin) && !(then >= smallest_sine(mesh_.F, t, mesh_.V));
    }
  });
  bool any = false;
  for (Eigen::Index t = 0; t < mesh_.F.rows(); ++t) {
    if (offends[t] == 0) continue;
    any = true;
    for (int k = 0; k < 3; ++k) direction.row(mesh_.F(t, k)).setZero();
  }
  return any;
}

bool SurfaceDescent::admit(double part, Eigen::MatrixX3d& direction,
                           Eigen::MatrixX3d& there) const {
  there = mesh_.V + part * direction;
  if (turns_too_far(there)) return false;
  for (int round = 0; round < kRoundsOfHolding; ++round) {
    if (!hold_thin(there, direction)) return true;
    there = mesh_.V + part * direction;
  }
  return false;
}

bool SurfaceDescent::search(Eigen::MatrixX3d direction) {
  const double longest = direction.rowwise().norm().maxCoeff();
  const double allowed = kLargestMove * mean_edge_;
  if (!(longest > 0)) return false;
  if (longest > allowed) direction *= allowed / longest;
  Eigen::MatrixX3d there, gradient;
  for (double part = 1; part > kShortestPart; part /= 2) {
    if (!admit(part, direction, there)) continue;
    const double slope = gradient_.cwiseProduct(direction).sum();
    if (!(slope < 0)) return false;
    const double value = evaluate(there, gradient);
    if (!(value <= value_ + kArmijo * part * slope)) continue;
    lbfgs_.add(there - mesh_.V, gradient - gradient_,
               [this](Eigen::MatrixX3d& values) { precondition(values); });
    mesh_.V = there;
    gradient_ = gradient;
    value_ = value;
    return true;
  }
  return false;
}

void SurfaceDescent::step() {
  if (finished_) return;
  const Preconditioner metric = [this](Eigen::MatrixX3d& values) { precondition(values); };
  bool found = search(lbfgs_.direction(gradient_, metric));
  if (!found) {  // what was remembered misleads
    lbfgs_.forget();
    found = search(lbfgs_.direction(gradient_, metric));
  }
  finished_ = !found;
  if (found) ++iterations_;
}

}  // namespace geoprior::sketch
