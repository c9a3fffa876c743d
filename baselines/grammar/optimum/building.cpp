#include "baselines/grammar/optimum/building.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "models/grammar/objects/building_layout.h"

namespace geoprior::grammar {
namespace {

/// Limits are asked for with this margin, and hold when they are violated by no more (m).
constexpr double kBuildingMargin = 1e-5;
constexpr double kBuildingSlack = 1e-6;  ///< of a solution's cost
constexpr double kBuildingGradient = 1e-7;
constexpr double kMultiplierStride = 50;  ///< of multipliers, in their last changes
constexpr double kOverhangLimit = kMostOverhang - kBuildingMargin;
/// Weights of violations: soft at first, so that it shows which limits count.
constexpr double kFirstLimitMu = 0.5, kLastLimitMu = 8;

/// Directions of the walls in their storey's frame.
constexpr double kWallX[] = {1, 0, -1, 0}, kWallY[] = {0, 1, 0, -1};
/// Corners of a storey, in shares of its width and depth.
constexpr double kStoreyCornerX[] = {-0.5, 0.5, 0.5, -0.5},
                 kStoreyCornerY[] = {-0.5, -0.5, 0.5, 0.5};

/// A key point in the terms of its storey: shares of the sides from the middle, lengths in the
/// storey's frame, a length along the wall that scales with its row, and a share of the height.
struct BuildingKey {
  double width = 0, depth = 0;
  Eigen::Vector2d fixed{0, 0};
  double scaled = 0;
  double up = 0;
  Eigen::Vector3d target{0, 0, 0};
};

/// Key points of an element. Blocks: plan (x, y, yaw, width, depth), floor, ceiling, row's scale.
struct BuildingElement {
  std::vector<BuildingKey> keys;
  double weight;
  int side;
  template <class T>
  bool operator()(const T* plan, const T* floor, const T* ceiling, const T* scale, T* out) const {
    using std::cos, std::sin;
    const T c = cos(plan[2]), s = sin(plan[2]);
    for (const BuildingKey& key : keys) {
      const T along = key.scaled * scale[0];
      const T x = key.width * plan[3] + key.fixed.x() + along * kWallX[side];
      const T y = key.depth * plan[4] + key.fixed.y() + along * kWallY[side];
      *out++ = weight * (plan[0] + c * x - s * y - key.target.x());
      *out++ = weight * (plan[1] + s * x + c * y - key.target.y());
      *out++ = weight * (floor[0] + key.up * (ceiling[0] - floor[0]) - key.target.z());
    }
    return true;
  }
};

/// Blocks: plan and ceiling of the top storey, rise of the roof.
struct RoofApex {
  Eigen::Vector3d target;
  double weight;
  template <class T>
  bool operator()(const T* plan, const T* ceiling, const T* rise, T* out) const {
    out[0] = weight * (plan[0] - target.x());
    out[1] = weight * (plan[1] - target.y());
    out[2] = weight * (ceiling[0] + rise[0] - target.z());
    return true;
  }
};

/// A constraint g <= 0 in the augmented Lagrangian, which adds mu / 2 max(0, g + lambda / mu)^2.
struct BuildingLimit {
  double mu = kFirstLimitMu;
  double lambda = 0;
  double change = 0;                   ///< of lambda, the last time
  std::function<double()> value = {};  ///< g, of the blocks as they are
};

/// The residual of a constraint that is linear in its blocks.
template <class Limit>
struct BuildingLinearLimit {
  Limit limit;
  const BuildingLimit* term;
  template <class T>
  bool operator()(const T* a, T* out) const {
    return set(limit.value(a), out);
  }
  template <class T>
  bool operator()(const T* a, const T* b, T* out) const {
    return set(limit.value(a, b), out);
  }
  template <class T>
  bool set(const T& g, T* out) const {
    const T shifted = g + term->lambda / term->mu;
    out[0] = shifted > T(0) ? std::sqrt(term->mu) * shifted : T(0);
    return true;
  }
};

/// Blocks: plans of a storey and of the one above. g = |r|^2 - limit^2, r between side middles.
struct OverhangLimit {
  int side;
  template <class T>
  std::array<T, 2> distance(const T* below, const T* above) const {
    using std::cos, std::sin;
    const auto middle = [&](const T* plan) -> std::array<T, 2> {
      const T r = (side == 0 || side == 3 ? -0.5 : 0.5) * plan[side % 2 == 0 ? 4 : 3];
      const T c = cos(plan[2]) * r, s = sin(plan[2]) * r;
      if (side % 2 == 0) return {plan[0] - s, plan[1] + c};
      return {plan[0] + c, plan[1] + s};
    };
    const auto a = middle(below), b = middle(above);
    return {b[0] - a[0], b[1] - a[1]};
  }
  template <class T>
  T value(const T* below, const T* above) const {
    const auto r = distance(below, above);
    return r[0] * r[0] + r[1] * r[1] - kOverhangLimit * kOverhangLimit;
  }
};

/// Its residuals. Where the constraint counts, lambda g + mu / 2 g^2 is, but for a constant, the
/// square of (sqrt(2 lambda) r, sqrt(mu) g) / 2: so Gauss and Newton's matrix has the curvature of
/// lambda g, without which steps along the limit would be much too long.
struct OverhangResidual {
  OverhangLimit limit;
  const BuildingLimit* term;
  template <class T>
  bool operator()(const T* below, const T* above, T* out) const {
    const double lambda = term->lambda;
    const T g = limit.value(below, above);
    const auto r = limit.distance(below, above);
    const bool counts = g + lambda / term->mu > T(0);
    const double beyond = 2 * lambda * kOverhangLimit * kOverhangLimit - lambda * lambda / term->mu;
    const double root = std::sqrt(2 * lambda);
    // The square root of 0 has no derivative: what does not count is a plain number.
    out[0] = counts ? root * r[0] : T(std::sqrt(std::max(0., beyond)));
    out[1] = counts ? root * r[1] : T(0);
    out[2] = counts ? std::sqrt(term->mu) * g : T(0);
    return true;
  }
};

/// One number of a block: sign (x - limit) <= 0.
struct BuildingNumberLimit {
  int number;
  double sign, limit;
  template <class T>
  T value(const T* block) const {
    return sign * (block[number] - limit) + kBuildingMargin;
  }
};

/// Blocks: floor and ceiling: sign (ceiling - floor - limit) <= 0.
struct StoreyHeightLimit {
  double sign, limit;
  template <class T>
  T value(const T* floor, const T* ceiling) const {
    return sign * (ceiling[0] - floor[0] - limit) + kBuildingMargin;
  }
};

/// Blocks: plan, scale of a row: the outermost opening ends before the wall does.
struct OpeningRowLimit {
  double reach, margin;
  int side;
  template <class T>
  T value(const T* plan, const T* scale) const {
    return reach * scale[0] + margin - plan[side % 2 == 0 ? 3 : 4] / 2. + kBuildingMargin;
  }
};

/// An opening in the terms of its wall.
struct RowOpening {
  int element;
  double middle;        ///< from the wall's middle, at the scale 1 (m)
  double width;         ///< m
  double sill, height;  ///< shares of the wall's height
};

struct RowVariables {
  int wall, side;
  std::vector<RowOpening> openings = {};
  double scale = 1;
};

struct StoreyVariables {
  int storey;
  std::array<double, 5> plan{};
  std::vector<RowVariables> rows = {};
};

std::array<double, 5> storey_plan_numbers(const Hierarchy& h, int storey) {
  const Eigen::Vector3d& x = h.position(storey);
  return {x.x(), x.y(), yaw_of(h.turn(storey)), h.parameter(storey, StoreyParameter::width),
          h.parameter(storey, StoreyParameter::depth)};
}

/// The variables of a building, and the problem whose unknowns they are.
class BuildingOptimum {
 public:
  BuildingOptimum(const Hierarchy& rest, const Hierarchy& fixed, const SpatialMap& map);
  BuildingOptimum(const BuildingOptimum&) = delete;
  BuildingOptimum& operator=(const BuildingOptimum&) = delete;

  /// The second start: rest as it is, moved with its ground; new storeys like those below them.
  void begin_at_rest();
  /// Nothing, where no point within the limits was found.
  std::optional<OptimumResult> solve(int start);

 private:
  [[nodiscard]] bool counts(int e) const { return e < rest_.size() && rest_.present(e); }
  void read_row(RowVariables& row) const;
  void add_element(int element, int storey, double* scale, int side, std::vector<BuildingKey> keys);
  void add_row(int storey, RowVariables& row);
  void add_roof();
  void add_limits();
  void add_row_limits(StoreyVariables& storey, RowVariables& row);
  template <int... sizes, class Limit, class... Blocks>
  void add_limit(Limit limit, Blocks... blocks);
  bool raise_multipliers(double cost);
  void write_storey(Hierarchy& state, int i) const;
  [[nodiscard]] Hierarchy state() const;
  [[nodiscard]] double deviation(const Hierarchy& state) const;

  const Hierarchy &rest_, &fixed_;
  const SpatialMap& map_;
  double share_ = 1;  ///< one over the number of elements that count
  std::vector<StoreyVariables> storeys_;
  std::vector<double> levels_;
  int roof_ = -1;
  double rise_ = 1;
  double unscaled_ = 1;  ///< the block of elements that are not in a row
  std::deque<BuildingLimit> terms_;
  ceres::Problem system_;
};

BuildingOptimum::BuildingOptimum(const Hierarchy& rest, const Hierarchy& fixed,
                                 const SpatialMap& map)
    : rest_(rest), fixed_(fixed), map_(map) {
  int elements = 0;
  for (int e = 0; e < rest.size(); ++e) elements += rest.present(e) && fixed.present(e);
  share_ = 1. / elements;
  for (const int storey : storeys_of(fixed, 0)) {
    StoreyVariables v{.storey = storey, .plan = storey_plan_numbers(fixed, storey)};
    levels_.push_back(fixed.position(storey).z());
    for (const int wall : present_children(fixed, storey, "wall")) {
      RowVariables row{.wall = wall,
                       .side = static_cast<int>(fixed.parameter(wall, WallParameter::side))};
      read_row(row);
      v.rows.push_back(std::move(row));
    }
    storeys_.push_back(std::move(v));
  }
  const int top = storeys_.back().storey;
  levels_.push_back(levels_.back() + fixed.parameter(top, StoreyParameter::height));
  for (const int roof : present_children(fixed, 0, "roof")) {
    roof_ = roof;
    rise_ = fixed.parameter(roof, RoofParameter::rise);
  }
}

void BuildingOptimum::read_row(RowVariables& row) const {
  const int wall = row.wall;
  const double length = fixed_.parameter(wall, WallParameter::length);
  const double height = fixed_.parameter(wall, WallParameter::height);
  const double rest_length = counts(wall) ? rest_.parameter(wall, WallParameter::length) : length;
  const double rest_height = counts(wall) ? rest_.parameter(wall, WallParameter::height) : height;
  std::vector<int> elements = present_children(fixed_, wall, "window");
  for (const int door : present_children(fixed_, wall, "door")) elements.push_back(door);
  const auto along = [](const Hierarchy& h, int e) {
    return h.parameter(e, OpeningParameter::along);
  };
  // The scale is read off the two outermost ones that were there.
  int first = -1, last = -1;
  for (const int e : elements) {
    if (!counts(e)) continue;
    if (first < 0 || along(rest_, e) < along(rest_, first)) first = e;
    if (last < 0 || along(rest_, e) > along(rest_, last)) last = e;
  }
  row.scale = first == last ? length / rest_length
                            : (along(fixed_, last) - along(fixed_, first)) /
                                  (along(rest_, last) - along(rest_, first));
  for (const int e : elements) {
    const Hierarchy& h = counts(e) ? rest_ : fixed_;
    const double middle =
        counts(e) ? along(rest_, e) - rest_length / 2 : (along(fixed_, e) - length / 2) / row.scale;
    const double of = counts(e) ? rest_height : height;
    row.openings.push_back({e, middle, fixed_.parameter(e, OpeningParameter::width),
                            h.parameter(e, OpeningParameter::sill) / of,
                            h.parameter(e, OpeningParameter::height) / of});
  }
  std::stable_sort(row.openings.begin(), row.openings.end(),
                   [](const auto& a, const auto& b) { return a.middle < b.middle; });
}

void BuildingOptimum::begin_at_rest() {
  const Eigen::Vector3d base = rest_.position(storeys_.front().storey);
  const Eigen::Vector3d shift = map_.at(base) - base;
  std::array<double, 5> plan{};
  double level = base.z() + shift.z();
  for (std::size_t i = 0; i < storeys_.size(); ++i) {
    StoreyVariables& v = storeys_[i];
    double height = kLeastStoreyHeight;
    if (counts(v.storey)) {
      plan = storey_plan_numbers(rest_, v.storey);
      plan[0] += shift.x();
      plan[1] += shift.y();
      height = rest_.parameter(v.storey, StoreyParameter::height);
    }
    v.plan = plan;
    levels_[i] = level;
    level += height;
    for (RowVariables& row : v.rows) row.scale = 1;
  }
  levels_.back() = level;
}

void BuildingOptimum::add_element(int element, int i, double* scale, int side,
                                  std::vector<BuildingKey> keys) {
  std::vector<Eigen::Vector3d> at_rest;
  rest_.keys(element, at_rest);
  for (std::size_t k = 0; k < keys.size(); ++k) keys[k].target = map_.at(at_rest[k]);
  const int count = static_cast<int>(keys.size());
  const double weight = std::sqrt(share_ / static_cast<double>(at_rest.size()));
  system_.AddResidualBlock(
      new ceres::AutoDiffCostFunction<BuildingElement, ceres::DYNAMIC, 5, 1, 1, 1>(
          new BuildingElement{std::move(keys), weight, side}, 3 * count),
      nullptr, storeys_[i].plan.data(), &levels_[i], &levels_[i + 1], scale);
}

void BuildingOptimum::add_row(int i, RowVariables& row) {
  const int s = row.side, next = (s + 1) % 4;
  if (counts(row.wall)) {
    std::vector<BuildingKey> keys;
    for (const auto& [corner, up] : {std::pair{s, 0.}, {next, 0.}, {next, 1.}, {s, 1.}})
      keys.push_back({.width = kStoreyCornerX[corner], .depth = kStoreyCornerY[corner], .up = up});
    add_element(row.wall, i, &unscaled_, 0, std::move(keys));
  }
  for (const RowOpening& o : row.openings) {
    if (!counts(o.element)) continue;
    std::vector<BuildingKey> keys;
    constexpr double kAlong[] = {0, -0.5, 0.5, 0.5, -0.5}, kUp[] = {0.5, 0, 0, 1, 1};
    for (int k = 0; k < 5; ++k)
      keys.push_back({.width = (kStoreyCornerX[s] + kStoreyCornerX[next]) / 2,
                      .depth = (kStoreyCornerY[s] + kStoreyCornerY[next]) / 2,
                      .fixed = kAlong[k] * o.width * Eigen::Vector2d(kWallX[s], kWallY[s]),
                      .scaled = o.middle,
                      .up = o.sill + kUp[k] * o.height});
    add_element(o.element, i, &row.scale, s, std::move(keys));
  }
}

void BuildingOptimum::add_roof() {
  const int top = static_cast<int>(storeys_.size()) - 1;
  if (roof_ < 0 || !counts(roof_)) return;
  const double eaves = rest_.parameter(roof_, RoofParameter::eaves);
  std::vector<BuildingKey> keys;
  for (int k = 0; k < 4; ++k)
    keys.push_back({.width = kStoreyCornerX[k],
                    .depth = kStoreyCornerY[k],
                    .fixed = 2 * eaves * Eigen::Vector2d(kStoreyCornerX[k], kStoreyCornerY[k]),
                    .up = 1});
  add_element(roof_, top, &unscaled_, 0, std::move(keys));
  std::vector<Eigen::Vector3d> at_rest;
  rest_.keys(roof_, at_rest);
  system_.AddResidualBlock(new ceres::AutoDiffCostFunction<RoofApex, 3, 5, 1, 1>(
                               new RoofApex{map_.at(at_rest.back()), std::sqrt(share_ / 5)}),
                           nullptr, storeys_[top].plan.data(), &levels_.back(), &rise_);
  add_limit<1>(BuildingNumberLimit{0, -1, kLeastRoofRise}, &rise_);
  add_limit<1>(BuildingNumberLimit{0, 1, kMostRoofRise}, &rise_);
}

template <int... sizes, class Limit, class... Blocks>
void BuildingOptimum::add_limit(Limit limit, Blocks... blocks) {
  BuildingLimit& term = terms_.emplace_back();
  term.value = [limit, blocks...] { return limit.value(static_cast<const double*>(blocks)...); };
  if constexpr (std::is_same_v<Limit, OverhangLimit>)
    system_.AddResidualBlock(new ceres::AutoDiffCostFunction<OverhangResidual, 3, sizes...>(
                                 new OverhangResidual{limit, &term}),
                             nullptr, blocks...);
  else
    system_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<BuildingLinearLimit<Limit>, 1, sizes...>(
            new BuildingLinearLimit<Limit>{limit, &term}),
        nullptr, blocks...);
}

void BuildingOptimum::add_row_limits(StoreyVariables& storey, RowVariables& row) {
  if (row.openings.empty()) return;
  double least = 0.05, most = 20, reach = 0, margin = 0;
  for (std::size_t k = 0; k < row.openings.size(); ++k) {
    const RowOpening& o = row.openings[k];
    if (k > 0) {
      const RowOpening& before = row.openings[k - 1];
      const double gap = o.middle - before.middle;
      Opening a, b;
      a.width = before.width;
      b.width = o.width;
      least = std::max(least, least_pitch(a, b) / gap);
      most = std::min(most, kMostPitch / gap);
    }
    reach = std::max(reach, std::abs(o.middle));
    margin = std::max(margin, kWallEnd + o.width / 2);
  }
  add_limit<5, 1>(OpeningRowLimit{reach, margin, row.side}, storey.plan.data(), &row.scale);
  add_limit<1>(BuildingNumberLimit{0, -1, std::min(least, most)}, &row.scale);
  add_limit<1>(BuildingNumberLimit{0, 1, most}, &row.scale);
  // A single opening in the middle has no distance to scale.
  if (reach < 1e-9) system_.SetParameterBlockConstant(&row.scale);
}

void BuildingOptimum::add_limits() {
  for (std::size_t i = 0; i < storeys_.size(); ++i) {
    StoreyVariables& storey = storeys_[i];
    for (RowVariables& row : storey.rows) add_row_limits(storey, row);
    add_limit<1, 1>(StoreyHeightLimit{-1, kLeastStoreyHeight}, &levels_[i], &levels_[i + 1]);
    add_limit<1, 1>(StoreyHeightLimit{1, kMostStoreyHeight}, &levels_[i], &levels_[i + 1]);
    if (i > 0)
      for (int side = 0; side < 4; ++side)
        add_limit<5, 5>(OverhangLimit{side}, storeys_[i - 1].plan.data(), storey.plan.data());
    for (const int side : {3, 4})
      add_limit<5>(BuildingNumberLimit{side, -1, kLeastStoreySide}, storey.plan.data());
  }
}

/// The new multipliers: true, when the state is within all limits, and what multipliers of limits
/// that are not reached are worth is no part of the deviation.
bool BuildingOptimum::raise_multipliers(double cost) {
  double violation = 0, slack = 0, along = 0, now = 0, before = 0, room = kMultiplierStride;
  for (BuildingLimit& term : terms_) {
    const double g = term.value(), then = std::max(0., term.lambda + term.mu * g);
    const double change = then - term.lambda;
    violation = std::max(violation, g);
    slack -= term.lambda * std::min(0., g);
    along += change * term.change;
    now += change * change;
    before += term.change * term.change;
    if (change < 0) room = std::min(room, then / -change);
    term.lambda = then;
    term.change = change;
    term.mu = std::min(2 * term.mu, kLastLimitMu);
  }
  // Where limits are redundant, as the four sides of a storey that only leans, multipliers wander
  // in a straight line from one to another.
  const bool straight = along > 0.98 * std::sqrt(now * before) && now > 0.25 * before;
  if (straight)
    for (BuildingLimit& term : terms_) term.lambda = std::max(0., term.lambda + room * term.change);
  return violation <= kBuildingMargin && slack <= kBuildingSlack * cost;
}

std::optional<OptimumResult> BuildingOptimum::solve(int start) {
  system_.AddParameterBlock(&unscaled_, 1);
  system_.SetParameterBlockConstant(&unscaled_);
  if (counts(0)) add_element(0, 0, &unscaled_, 0, {BuildingKey{}});
  for (int i = 0; i < std::ssize(storeys_); ++i) {
    if (const int storey = storeys_[i].storey; counts(storey)) {
      std::vector<BuildingKey> keys;
      for (int k = 0; k < 8; ++k)
        keys.push_back({.width = kStoreyCornerX[k % 4],
                        .depth = kStoreyCornerY[k % 4],
                        .up = k < 4 ? 0. : 1.});
      add_element(storey, i, &unscaled_, 0, std::move(keys));
    }
    for (RowVariables& row : storeys_[i].rows) add_row(i, row);
  }
  add_roof();
  add_limits();
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.function_tolerance = 0;
  options.parameter_tolerance = 0;
  options.gradient_tolerance = 1e-9;
  options.logging_type = ceres::SILENT;
  OptimumResult result;
  bool done = false;
  for (int round = 0; round < 60 && !done; ++round) {
    // The first multipliers are estimates, worth no exact solve.
    options.max_num_iterations = std::min(10 + 5 * round, 50);
    ceres::Solver::Summary summary;
    ceres::Solve(options, &system_, &summary);
    result.iterations += static_cast<int>(summary.iterations.size());
    result.gradient = summary.iterations.back().gradient_max_norm;
    done = raise_multipliers(summary.final_cost) && result.gradient < kBuildingGradient;
  }
  if (!done) return std::nullopt;
  result.state = state();
  result.deviation = deviation(result.state);
  result.start = start;
  return result;
}

void BuildingOptimum::write_storey(Hierarchy& h, int i) const {
  const auto& [storey, plan, rows] = storeys_[i];
  // A violation by round-off of a constraint is none of a parameter's range.
  const double height =
      std::clamp(levels_[i + 1] - levels_[i], kLeastStoreyHeight, kMostStoreyHeight);
  const Pose pose{{plan[0], plan[1], levels_[i]}, turn_of_yaw(plan[2])};
  h.set_pose(storey, pose);
  const double width = std::max(plan[3], kLeastStoreySide);
  const double depth = std::max(plan[4], kLeastStoreySide);
  h.set_parameter(storey, StoreyParameter::width, width);
  h.set_parameter(storey, StoreyParameter::depth, depth);
  h.set_parameter(storey, StoreyParameter::height, height);
  for (const RowVariables& row : rows) {
    const Pose wall = wall_pose(pose, row.side, width, depth);
    h.set_pose(row.wall, wall);
    const std::vector<double> values = wall_parameters(row.side, width, depth, height);
    for (int p = 0; p < std::ssize(values); ++p) h.set_parameter(row.wall, p, values[p]);
    for (const RowOpening& o : row.openings) {
      const Opening opening{.along = values[WallParameter::length] / 2 + row.scale * o.middle,
                            .width = o.width,
                            .sill = o.sill * height,
                            .height = o.height * height};
      h.set_pose(o.element, opening_pose(wall, opening));
      h.set_parameter(o.element, OpeningParameter::along, opening.along);
      h.set_parameter(o.element, OpeningParameter::height, opening.height);
      h.set_parameter(o.element, OpeningParameter::sill, opening.sill);
    }
  }
}

Hierarchy BuildingOptimum::state() const {
  Hierarchy h = fixed_;
  for (int i = 0; i < std::ssize(storeys_); ++i) write_storey(h, i);
  h.set_pose(0, h.pose(storeys_.front().storey));
  if (roof_ < 0) return h;
  const auto& [top, plan, rows] = storeys_.back();
  h.set_pose(roof_, {{plan[0], plan[1], levels_.back()}, h.turn(top)});
  h.set_parameter(roof_, RoofParameter::width, h.parameter(top, StoreyParameter::width));
  h.set_parameter(roof_, RoofParameter::depth, h.parameter(top, StoreyParameter::depth));
  h.set_parameter(roof_, RoofParameter::rise, std::clamp(rise_, kLeastRoofRise, kMostRoofRise));
  return h;
}

double BuildingOptimum::deviation(const Hierarchy& state) const {
  double sum = 0;
  std::vector<Eigen::Vector3d> before, after;
  for (int e = 0; e < rest_.size(); ++e) {
    if (!rest_.present(e) || !state.present(e)) continue;
    before.clear();
    after.clear();
    rest_.keys(e, before);
    state.keys(e, after);
    double own = 0;
    for (std::size_t k = 0; k < before.size(); ++k)
      own += (after[k] - map_.at(before[k])).squaredNorm();
    sum += own / static_cast<double>(before.size());
  }
  return std::sqrt(share_ * sum);
}

}  // namespace

OptimumResult optimise_building(const Hierarchy& rest, const Hierarchy& children_fixed,
                                const SpatialMap& map) {
  if (storeys_of(children_fixed, 0).empty()) throw Error("has no storeys", "building");
  std::optional<OptimumResult> best;
  for (const int start : {0, 1}) {
    BuildingOptimum optimum(rest, children_fixed, map);
    if (start == 1) optimum.begin_at_rest();
    std::optional<OptimumResult> result = optimum.solve(start);
    if (result && (!best || result->deviation < best->deviation)) best = std::move(result);
  }
  if (!best) throw Error("no state within its constraints was found", "building");
  return std::move(*best);
}

}  // namespace geoprior::grammar
