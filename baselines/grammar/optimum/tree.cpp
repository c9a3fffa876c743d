#include "baselines/grammar/optimum/tree.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "core/error.h"
#include "models/grammar/objects/tree.h"

namespace geoprior::grammar {
namespace {

using Eigen::Vector3d;
using Branch = BranchParameter;

/// The unknowns of a branch.
struct BranchUnknowns {
  Vector3d direction{0, 0, 1};
  double length = 0;
};

/// scale (root + sum over a chain of branches of share L d - target); blocks are d, L of each.
class PointOnChain final : public ceres::CostFunction {
 public:
  PointOnChain(std::vector<double> shares, const Vector3d& offset, double scale)
      : shares_(std::move(shares)), offset_(offset), scale_(scale) {
    set_num_residuals(3);
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      mutable_parameter_block_sizes()->push_back(3);
      mutable_parameter_block_sizes()->push_back(1);
    }
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    Vector3d r = offset_;
    for (std::size_t i = 0; i < shares_.size(); ++i) {
      const Eigen::Map<const Vector3d> direction(blocks[2 * i]);
      const double length = blocks[2 * i + 1][0];
      r += (shares_[i] * length) * direction;
      if (jacobians == nullptr) continue;
      if (double* by_direction = jacobians[2 * i]; by_direction != nullptr) {
        Eigen::Map<RowMajor> out(by_direction);
        out = (scale_ * shares_[i] * length) * RowMajor::Identity();
      }
      if (double* by_length = jacobians[2 * i + 1]; by_length != nullptr) {
        Eigen::Map<Vector3d> out(by_length);
        out = (scale_ * shares_[i]) * direction;
      }
    }
    for (int k = 0; k < 3; ++k) residuals[k] = scale_ * r[k];
    return true;
  }

 private:
  std::vector<double> shares_;
  Vector3d offset_;
  double scale_;
};

/// Where the map takes the ends of all branches, and who hangs on whom.
struct TreeTargets {
  int tree = -1;
  Vector3d root;
  std::vector<int> branches;        ///< parents before children
  std::vector<Vector3d> base, tip;  ///< by element
};

TreeTargets tree_targets(const Hierarchy& rest, const SpatialMap& map) {
  TreeTargets out;
  out.tree = 0;
  while (out.tree < rest.size() && rest.type(out.tree).name != "tree") ++out.tree;
  if (out.tree == rest.size()) throw Error("there is no tree", "optimise_tree");
  out.root = map.at(rest.position(out.tree));
  out.base.resize(rest.size());
  out.tip.resize(rest.size());
  for (int e = 0; e < rest.size(); ++e) {
    if (!rest.present(e) || rest.type(e).name != "branch" || !rest.is_below(e, out.tree)) continue;
    out.branches.push_back(e);
    out.base[e] = map.at(rest.position(e));
    out.tip[e] = map.at(attach_point(rest, e, 1));
  }
  return out;
}

/// Every branch from where its parent carries it straight to where its tip is wanted.
std::vector<BranchUnknowns> retargeted(const Hierarchy& rest, const TreeTargets& targets) {
  std::vector<BranchUnknowns> out(rest.size());
  std::vector<Vector3d> base(rest.size());
  for (const int e : targets.branches) {
    const int parent = rest.parent(e);
    base[e] = parent == targets.tree
                  ? targets.root
                  : Vector3d(base[parent] + rest.parameter(e, Branch::kAttach) *
                                                out[parent].length * out[parent].direction);
    const Vector3d along = targets.tip[e] - base[e];
    out[e].direction = along.norm() > 1e-9 ? along.normalized() : branch_axis(rest, e);
    out[e].length = std::clamp(along.norm(), kShortestBranch * rest.parameter(e, Branch::kMean),
                               kLongestBranch * rest.parameter(e, Branch::kMean));
  }
  return out;
}

std::vector<BranchUnknowns> unknowns_of(const Hierarchy& state, const TreeTargets& targets) {
  std::vector<BranchUnknowns> out(state.size());
  for (const int e : targets.branches) {
    if (e >= state.size() || !state.present(e))
      throw Error("a branch that was there at rest is missing", "optimise_tree");
    out[e] = {branch_axis(state, e), state.parameter(e, Branch::kLength)};
  }
  return out;
}

void add_point(ceres::Problem& problem, const Hierarchy& rest, const TreeTargets& targets,
               std::vector<BranchUnknowns>& x, int branch, double attach, const Vector3d& target) {
  std::vector<double> shares;
  std::vector<double*> blocks;
  for (int e = branch; e != targets.tree; e = rest.parent(e)) {
    shares.push_back(attach);
    blocks.push_back(x[e].direction.data());
    blocks.push_back(&x[e].length);
    attach = rest.parameter(e, Branch::kAttach);
  }
  problem.AddResidualBlock(
      new PointOnChain(std::move(shares), targets.root - target, std::sqrt(0.5)), nullptr, blocks);
}

/// Bounds of a length that is an unknown (m).
struct LengthBounds {
  double low, high;
};
LengthBounds length_bounds(const Hierarchy& rest, int branch) {
  const double mean = rest.parameter(branch, Branch::kMean);
  return {kShortestBranch * mean, kLongestBranch * mean};
}

/// Sets the lengths constant that lie on a bound and would go beyond it, the others free.
/// @return  largest component of the gradient without those
double project_gradient(const Hierarchy& rest, const TreeTargets& targets,
                        std::vector<BranchUnknowns>& x, ceres::Problem& problem) {
  ceres::Problem::EvaluateOptions in_order;
  for (const int e : targets.branches) {
    problem.SetParameterBlockVariable(&x[e].length);
    in_order.parameter_blocks.push_back(x[e].direction.data());
    in_order.parameter_blocks.push_back(&x[e].length);
  }
  std::vector<double> gradient;
  problem.Evaluate(in_order, nullptr, nullptr, &gradient, nullptr);
  double largest = 0;
  std::size_t i = 0;
  for (const int e : targets.branches) {
    largest = std::max({largest, std::abs(gradient[i]), std::abs(gradient[i + 1])});
    const double by_length = gradient[i + 2];
    i += 3;
    const auto [low, high] = length_bounds(rest, e);
    if ((x[e].length <= low && by_length > 0) || (x[e].length >= high && by_length < 0))
      problem.SetParameterBlockConstant(&x[e].length);
    else
      largest = std::max(largest, std::abs(by_length));
  }
  return largest;
}

struct SolvedTree {
  int iterations = 0;
  double gradient = 0;
};

/// Rounds of Levenberg and Marquardt's method: its steps do not see bounds and stall where several
/// are met, so a round begins with the lengths fixed that are on their bound.
SolvedTree solve_tree(const Hierarchy& rest, const TreeTargets& targets,
                      std::vector<BranchUnknowns>& x) {
  constexpr double kSmallGradient = 1e-7;
  constexpr int kRounds = 60;
  ceres::SphereManifold<3> sphere;
  ceres::Problem::Options ownership;
  ownership.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(ownership);
  for (const int e : targets.branches) {
    const auto [low, high] = length_bounds(rest, e);
    problem.AddParameterBlock(x[e].direction.data(), 3, &sphere);
    problem.AddParameterBlock(&x[e].length, 1);
    problem.SetParameterLowerBound(&x[e].length, 0, low);
    problem.SetParameterUpperBound(&x[e].length, 0, high);
    x[e].length = std::clamp(x[e].length, low, high);
  }
  for (const int e : targets.branches) {
    add_point(problem, rest, targets, x, e, 1, targets.tip[e]);
    if (rest.parent(e) != targets.tree)
      add_point(problem, rest, targets, x, rest.parent(e), rest.parameter(e, Branch::kAttach),
                targets.base[e]);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.max_num_iterations = 40;
  options.gradient_tolerance = kSmallGradient;
  options.function_tolerance = 1e-16;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  SolvedTree out{0, project_gradient(rest, targets, x, problem)};
  for (int round = 0; round < kRounds && out.gradient > kSmallGradient; ++round) {
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    out.iterations += static_cast<int>(summary.iterations.size()) - 1;
    out.gradient = project_gradient(rest, targets, x, problem);
  }
  return out;
}

/// The state of the unknowns; branches that were not there at rest turn with their parents.
Hierarchy tree_of(const Hierarchy& children_fixed, const TreeTargets& targets,
                  const std::vector<BranchUnknowns>& x) {
  Hierarchy out = children_fixed;
  out.set_position(targets.tree, targets.root);
  std::vector<char> optimised(out.size(), 0);
  for (const int e : targets.branches) optimised[e] = 1;
  for (int e = 0; e < out.size(); ++e) {
    if (!out.present(e) || out.type(e).name != "branch" || !out.is_below(e, targets.tree)) continue;
    const int parent = out.parent(e);
    const Vector3d base = attach_point(out, parent, out.parameter(e, Branch::kAttach));
    if (optimised[e] != 0) {
      out.set_parameter(e, Branch::kLength, x[e].length);
      out.set_pose(e, {base, turned_along(out.turn(e), x[e].direction)});
    } else {
      const Eigen::Quaterniond turned = out.turn(parent) * children_fixed.turn(parent).conjugate();
      out.set_pose(e, {base, (turned * out.turn(e)).normalized()});
    }
  }
  return out;
}

/// Root of the mean over elements of the mean squared deviation of their key points; that of the
/// tree itself is where the map takes it.
double tree_deviation(const Hierarchy& state, const TreeTargets& targets) {
  double sum = (state.position(targets.tree) - targets.root).squaredNorm();
  for (const int e : targets.branches)
    sum += 0.5 * ((state.position(e) - targets.base[e]).squaredNorm() +
                  (attach_point(state, e, 1) - targets.tip[e]).squaredNorm());
  return std::sqrt(sum / static_cast<double>(targets.branches.size() + 1));
}

}  // namespace

OptimumResult optimise_tree(const Hierarchy& rest, const Hierarchy& children_fixed,
                            const SpatialMap& map) {
  const TreeTargets targets = tree_targets(rest, map);
  OptimumResult out;
  for (const int start : {0, 1}) {
    std::vector<BranchUnknowns> x =
        start == 0 ? unknowns_of(children_fixed, targets) : retargeted(rest, targets);
    const SolvedTree solved = solve_tree(rest, targets, x);
    Hierarchy state = tree_of(children_fixed, targets, x);
    const double deviation = tree_deviation(state, targets);
    if (start > 0 && deviation >= out.deviation) continue;
    out = {std::move(state), deviation, solved.gradient, solved.iterations, start};
  }
  return out;
}

}  // namespace geoprior::grammar
