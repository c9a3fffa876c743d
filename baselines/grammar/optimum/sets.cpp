#include "baselines/grammar/optimum/sets.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"

namespace geoprior::grammar {
namespace {

constexpr double kGradientGoal = 2e-8;    // m, of the Lagrangian
constexpr double kPairGoal = 3e-10;       // m, of pairs that push
constexpr double kPairFeasible = 1e-9;    // m
constexpr double kNoTargetWeight = 1e-6;  // of elements that were not there before
constexpr double kNearPair = 1.2;         // distances over the least one of pairs that are watched
constexpr double kFirstPenalty = 10, kMostPenalty = 200, kPenaltyGrowth = 4;
constexpr int kMostUpdates = 60, kMostInnerSteps = 100;

/// An element of the set: what it is pulled to.
struct SetBody {
  int element = 0;
  bool is_upright = false;  ///< of fixed turn, at its height
  double reach = 0;         ///< size * radius (m)
  double weight = kNoTargetWeight;
  Eigen::Vector3d centre{0, 0, 0};      ///< target of the key at its origin
  std::optional<Eigen::Vector3d> tip;   ///< target of the key off its origin
  Eigen::Vector3d tip_offset{0, 0, 0};  ///< in its own frame (m)
};

/// sqrt(weight) (x - target).
class CentreCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  CentreCost(const Eigen::Vector3d& target, double weight)
      : target_(target), root_(std::sqrt(weight)) {}
  bool Evaluate(double const* const* blocks, double* out, double** jacobians) const override {
    for (int k = 0; k < 3; ++k) out[k] = root_ * (blocks[0][k] - target_[k]);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    for (int k = 0; k < 9; ++k) jacobians[0][k] = k % 4 == 0 ? root_ : 0;
    return true;
  }

 private:
  Eigen::Vector3d target_;
  double root_;
};

void write_row(const Eigen::Vector3d& row, double* out) { std::copy_n(row.data(), 3, out); }

/// sqrt(weight) (|x - target| - length): of a tip whose direction is free.
class TipCost final : public ceres::SizedCostFunction<1, 3> {
 public:
  TipCost(const Eigen::Vector3d& target, double length, double weight)
      : target_(target), length_(length), root_(std::sqrt(weight)) {}
  bool Evaluate(double const* const* blocks, double* out, double** jacobians) const override {
    const Eigen::Vector3d d = Eigen::Map<const Eigen::Vector3d>(blocks[0]) - target_;
    out[0] = root_ * (d.norm() - length_);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    write_row(root_ * d.normalized(), jacobians[0]);
    return true;
  }

 private:
  Eigen::Vector3d target_;
  double length_, root_;
};

/// From y to x, of length 1; some direction where they coincide.
Eigen::Vector3d pair_direction(const Eigen::Vector3d& x, const Eigen::Vector3d& y) {
  const Eigen::Vector3d d = x - y;
  const double length = d.norm();
  if (!(length > 0)) return Eigen::Vector3d::UnitX();
  return d / length;
}

/// sqrt(penalty) max(0, least - |x - y| + multiplier / penalty).
class PairCost final : public ceres::SizedCostFunction<1, 3, 3> {
 public:
  PairCost(double least, double multiplier, double penalty)
      : bound_(least + multiplier / penalty), root_(std::sqrt(penalty)) {}
  bool Evaluate(double const* const* blocks, double* out, double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> x(blocks[0]), y(blocks[1]);
    const double lacking = bound_ - (x - y).norm();
    out[0] = root_ * std::max(0., lacking);
    if (jacobians == nullptr) return true;
    const double slope = lacking > 0 ? root_ : 0;
    const Eigen::Vector3d n = slope * pair_direction(x, y);
    if (jacobians[0] != nullptr) write_row(-n, jacobians[0]);
    if (jacobians[1] != nullptr) write_row(n, jacobians[1]);
    return true;
  }

 private:
  double bound_, root_;
};

/// Where the map takes the keys, as targets of the position; keys of a free turn keep their
/// lengths.
void set_targets(const Hierarchy& rest, const Hierarchy& given, const SpatialMap& map,
                 SetBody& body) {
  std::vector<Eigen::Vector3d> keys, offsets;
  rest.keys(body.element, keys);
  given.type(body.element).keys(given.parameters(body.element), offsets);
  if (!body.is_upright) {
    body.weight = 1. / static_cast<double>(keys.size());
    body.centre = map.at(keys[0]);
    if (keys.size() < 2) return;
    body.tip = map.at(keys[1]);
    body.tip_offset = offsets[1];
    return;
  }
  // Of a fixed turn: the mean square over keys is that from the mean, and a constant.
  body.weight = 1;
  body.centre.setZero();
  for (std::size_t k = 0; k < keys.size(); ++k)
    body.centre += map.at(keys[k]) - given.turn(body.element) * offsets[k];
  body.centre /= static_cast<double>(keys.size());
  body.centre.z() = given.position(body.element).z();
}

std::vector<SetBody> bodies_of_set(const Hierarchy& rest, const Hierarchy& given,
                                   const SpatialMap& map) {
  std::vector<SetBody> bodies;
  const ElementType& root = given.type(0);
  const bool is_packed = root.name != "forest" || given.parameter(0, root.parameter("spacing")) > 0;
  for (int e = 0; e < given.size(); ++e) {
    const ElementType& type = given.type(e);
    const bool is_upright = type.name == "conifer";
    if (!given.present(e) || !(is_upright || type.name == "item" || type.name == "grain")) continue;
    SetBody body;
    body.element = e;
    body.is_upright = is_upright;
    if (is_packed)
      body.reach =
          given.parameter(e, type.parameter("size")) * given.parameter(e, type.parameter("radius"));
    body.centre = given.position(e);
    if (e < rest.size() && rest.present(e)) set_targets(rest, given, map, body);
    bodies.push_back(std::move(body));
  }
  if (bodies.empty()) throw Error("has no elements of a set", "object", "items, grains, conifers");
  return bodies;
}

/// RMS over the elements that were there before of the RMS over their keys (m).
double set_deviation(const Hierarchy& rest, const Hierarchy& state, const SpatialMap& map) {
  double sum = 0;
  int count = 0;
  std::vector<Eigen::Vector3d> before, after;
  for (int e = 0; e < rest.size(); ++e) {
    if (!rest.present(e) || !state.present(e)) continue;
    before.clear();
    after.clear();
    rest.keys(e, before);
    state.keys(e, after);
    if (before.empty() || before.size() != after.size()) continue;
    double squares = 0;
    for (std::size_t k = 0; k < before.size(); ++k)
      squares += (after[k] - map.at(before[k])).squaredNorm();
    sum += squares / static_cast<double>(before.size());
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0;
}

using PairOfSet = std::pair<int, int>;

/// One start of the augmented Lagrangian: positions, and a multiplier a pair that is watched.
class SetSolver {
 public:
  SetSolver(const std::vector<SetBody>& bodies, std::vector<Eigen::Vector3d> start)
      : bodies_(bodies), x_(std::move(start)) {
    for (const SetBody& body : bodies) largest_ = std::max(largest_, body.reach);
  }

  /// Whether gradient and pairs came as far as they should.
  bool solve();
  [[nodiscard]] const std::vector<Eigen::Vector3d>& positions() const { return x_; }
  [[nodiscard]] double gradient() const { return gradient_; }
  [[nodiscard]] int steps() const { return steps_; }
  /// By how much the nearest pair is too near (m).
  [[nodiscard]] double lacking() const {
    double most = 0;
    for (const auto& [i, j] : near_pairs()) most = std::max(most, -gap(i, j));
    return most;
  }

 private:
  [[nodiscard]] double least(int i, int j) const { return bodies_[i].reach + bodies_[j].reach; }
  [[nodiscard]] double gap(int i, int j) const { return (x_[i] - x_[j]).norm() - least(i, j); }
  [[nodiscard]] std::vector<PairOfSet> near_pairs() const;
  void watch_near_pairs();
  void minimise(double penalty, double goal);
  double update_multipliers(double penalty);

  const std::vector<SetBody>& bodies_;
  std::vector<Eigen::Vector3d> x_;
  std::map<PairOfSet, double> multiplier_;
  double largest_ = 0, gradient_ = 0;
  int steps_ = 0;
};

std::vector<PairOfSet> SetSolver::near_pairs() const {
  std::vector<int> order(x_.size());
  for (int i = 0; i < std::ssize(order); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::pair(x_[a].x(), a) < std::pair(x_[b].x(), b); });
  std::vector<PairOfSet> pairs;
  for (int a = 0; a < std::ssize(order); ++a) {
    const int i = order[a];
    const double reach = kNearPair * (bodies_[i].reach + largest_);
    for (int b = a + 1; b < std::ssize(order); ++b) {
      const int j = order[b];
      if (x_[j].x() - x_[i].x() > reach) break;
      if ((x_[i] - x_[j]).norm() < kNearPair * least(i, j)) pairs.push_back(std::minmax(i, j));
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

void SetSolver::watch_near_pairs() {
  std::map<PairOfSet, double> watched;
  for (const PairOfSet& pair : near_pairs()) watched.emplace(pair, 0);
  for (const auto& [pair, force] : multiplier_)
    if (force > 0) watched[pair] = force;
  multiplier_ = std::move(watched);
}

void SetSolver::minimise(double penalty, double goal) {
  ceres::Problem problem;
  for (int i = 0; i < std::ssize(bodies_); ++i) {
    const SetBody& body = bodies_[i];
    double* x = x_[i].data();
    problem.AddResidualBlock(new CentreCost(body.centre, body.weight), nullptr, x);
    if (body.tip)
      problem.AddResidualBlock(new TipCost(*body.tip, body.tip_offset.norm(), body.weight), nullptr,
                               x);
  }
  for (int i = 0; i < std::ssize(bodies_); ++i)
    if (bodies_[i].is_upright) problem.SetManifold(x_[i].data(), new ceres::SubsetManifold(3, {2}));
  for (const auto& [pair, force] : multiplier_)
    problem.AddResidualBlock(new PairCost(least(pair.first, pair.second), force, penalty), nullptr,
                             x_[pair.first].data(), x_[pair.second].data());
  ceres::Solver::Options solver;
  solver.max_num_iterations = kMostInnerSteps;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  solver.gradient_tolerance = goal;
  solver.function_tolerance = 0;
  solver.parameter_tolerance = 0;
  solver.initial_trust_region_radius = 1e8;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  gradient_ = summary.iterations.empty() ? 0 : summary.iterations.back().gradient_max_norm;
  steps_ += static_cast<int>(summary.iterations.size());
}

/// lambda <- max(0, lambda + rho (d - |x_i - x_j|)); the largest change over rho (m): 0 where all
/// pairs keep their distance, and those that push are at it.
double SetSolver::update_multipliers(double penalty) {
  double most = 0;
  for (auto& [pair, force] : multiplier_) {
    const double next = std::max(0., force - penalty * gap(pair.first, pair.second));
    most = std::max(most, std::abs(next - force) / penalty);
    force = next;
  }
  return most;
}

bool SetSolver::solve() {
  double penalty = kFirstPenalty, before = largest_;
  for (int update = 0; update < kMostUpdates; ++update) {
    watch_near_pairs();
    minimise(penalty, std::clamp(1e-2 * before, kGradientGoal, 1e-3));
    const double change = update_multipliers(penalty);
    if (change <= kPairGoal && gradient_ <= 5 * kGradientGoal && lacking() <= kPairGoal)
      return true;
    if (change > before / 4) penalty = std::min(kMostPenalty, kPenaltyGrowth * penalty);
    before = change;
  }
  return false;
}

Hierarchy placed_set(const Hierarchy& given, const std::vector<SetBody>& bodies,
                     const std::vector<Eigen::Vector3d>& x) {
  Hierarchy state = given;
  for (int i = 0; i < std::ssize(bodies); ++i) {
    const SetBody& body = bodies[i];
    Pose pose{x[i], given.turn(body.element)};
    if (body.tip)
      pose.turn =
          Eigen::Quaterniond::FromTwoVectors(pose.turn * body.tip_offset, *body.tip - x[i]) *
          pose.turn;
    state.set_pose(body.element, pose);
  }
  return state;
}

}  // namespace

OptimumResult optimise_set(const Hierarchy& rest, const Hierarchy& children_fixed,
                           const SpatialMap& map) {
  const std::vector<SetBody> bodies = bodies_of_set(rest, children_fixed, map);
  std::optional<OptimumResult> best;
  bool best_is_done = false;
  for (const int start : {0, 1}) {
    std::vector<Eigen::Vector3d> x;
    for (const SetBody& body : bodies)
      x.push_back(start == 0 ? children_fixed.position(body.element) : body.centre);
    SetSolver solver(bodies, std::move(x));
    const bool is_done = solver.solve();
    if (!is_done && solver.lacking() > kPairFeasible) continue;
    OptimumResult result{placed_set(children_fixed, bodies, solver.positions()), 0,
                         solver.gradient(), solver.steps(), start};
    result.deviation = set_deviation(rest, result.state, map);
    if (best && (best_is_done && !is_done)) continue;
    if (best && best_is_done == is_done && best->deviation <= result.deviation) continue;
    best = std::move(result);
    best_is_done = is_done;
  }
  if (!best) throw Error("no start leads to pairs that keep their distance", "optimum of a set");
  return std::move(*best);
}

}  // namespace geoprior::grammar
