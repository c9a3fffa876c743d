#include "models/torus/sampling.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"
#include "core/random.h"
#include "models/torus/directions.h"

namespace geoprior::torus {
namespace {

/// The smallest 2^a 3^b 5^c that is no smaller, which Fourier transforms are fast at.
double smooth_number(double least) {
  double best = std::exp2(std::ceil(std::log2(least)));
  for (double fives = 1; fives < best; fives *= 5)
    for (double odd = fives; odd < best; odd *= 3)
      best = std::min(best, odd * std::exp2(std::max(0., std::ceil(std::log2(least / odd)))));
  return best;
}

/// Makes the plan of one frame: what it asks for after how many corrugations.
class FramePlanner {
 public:
  FramePlanner(const TorusInput& input, std::optional<int> grid) : input_(input), grid_(grid) {}

  [[nodiscard]] FramePlan of_corrugation(int count) const {
    FramePlan plan;
    plan.parameter = count;
    plan.corrugations = count;
    add_surface(plan, "surface", input_.sampling.view, std::nullopt);
    if (const auto& detail = input_.sampling.detail)
      add_surface(plan, "detail", detail, 1 / detail->width);
    add_windows(plan);
    add_curves(plan);
    return plan;
  }

  [[nodiscard]] FramePlan of_view(int number) const {
    FramePlan plan;
    plan.parameter = number;
    plan.corrugations = static_cast<int>(input_.corrugations.size());
    SquareWindow view = input_.sampling.view.value_or(SquareWindow{});
    const double magnification = std::pow(input_.sampling.nearer, number);
    view.width /= magnification;
    add_surface(plan, "surface", view, magnification);
    return plan;
  }

  /// The whole torus as a grid.
  void add_whole(FramePlan& plan, int n) const {
    Eigen::MatrixX2d at(static_cast<Eigen::Index>(n) * n, 2);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        at.row(static_cast<Eigen::Index>(j) * n + i) << known(static_cast<double>(i) / n),
            known(static_cast<double>(j) / n);
    add(plan, "grid", plan.corrugations, std::move(at));
  }

 private:
  /// The nearest parameter that the method knows.
  [[nodiscard]] double known(double x) const { return grid_ ? std::round(x * *grid_) / *grid_ : x; }

  void add(FramePlan& plan, std::string name, int corrugations, Eigen::MatrixX2d at) const {
    plan.parts.push_back({std::move(name), {corrugations, std::move(at)}, std::nullopt});
  }

  [[noreturn]] void refuse_between_nodes(const std::string& name, double width) const {
    std::ostringstream text;
    text << "a square of width " << width << " lies between the nodes of a grid of " << *grid_
         << " points";
    throw Error(text.str(), name == "detail" ? "scene.detail.width" : "scene.view");
  }

  /// As many points as asked for, or as the method's grid has.
  void add_surface(FramePlan& plan, const std::string& name,
                   const std::optional<SquareWindow>& view,
                   std::optional<double> magnification) const {
    const SquareWindow square = view.value_or(SquareWindow{{0.5, 0.5}, 1});
    const int open = view ? 1 : 0;  // the last point is not the first one
    int n = input_.sampling.surface;
    if (grid_) {
      if (square.width * *grid_ < 1) refuse_between_nodes(name, square.width);
      n = std::min(n, static_cast<int>(square.width * *grid_) + open);
    }
    Eigen::MatrixX2d at(static_cast<Eigen::Index>(n) * n, 2);
    const Eigen::Vector2d corner = square.centre.array() - square.width / 2;
    const double step = square.width / (n - open);
    Eigen::Index row = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        at.row(row++) << known(corner.x() + step * i), known(corner.y() + step * j);
    plan.parts.push_back(
        {name, {plan.corrugations, std::move(at)}, Lattice{n, !view, magnification}});
  }

  /// Places are drawn in the square, the same for all frames.
  [[nodiscard]] WindowSet window_set(const std::string& name, int side, double step) const {
    const Sampling& sampling = input_.sampling;
    WindowSet set{name, side, grid_ ? 1. / *grid_ : step, Eigen::MatrixX2d(sampling.windows, 2)};
    RandomStream random(sampling.seed, "windows");
    for (Eigen::Index w = 0; w < set.corner.rows(); ++w)
      for (int k = 0; k < 2; ++k) set.corner(w, k) = known(random.uniform());
    return set;
  }

  void add_windows(FramePlan& plan) const {
    const double finest = finest_periods(input_, plan.corrugations);
    WindowSet fine = window_set("windows", kWindowSide, 1 / (kSamplesPerPeriod * finest));
    const Eigen::MatrixX2d at = fine.parameters();
    add(plan, "windows", plan.corrugations, at);
    if (plan.corrugations > 0) {
      add(plan, "windows_before", plan.corrugations - 1, at);
      add(plan, "windows_base", stage_base(input_, plan.corrugations - 1), at);
    }
    plan.windows.push_back(std::move(fine));
    if (grid_) return;
    for (const int samples : kCoarseSamples) {
      WindowSet coarse =
          window_set("windows_" + std::to_string(samples), kCoarseSide, 1 / (samples * finest));
      add(plan, coarse.name, plan.corrugations, coarse.parameters());
      plan.windows.push_back(std::move(coarse));
    }
  }

  /// Closed curves from a drawn place, their last point left out: it is the first.
  void add_curves(FramePlan& plan) const {
    const double finest = finest_periods(input_, plan.corrugations);
    if (grid_ && *grid_ % 2 != 0) return;  // lengths compare every point with every other
    const double half = grid_ ? *grid_ / 2. : smooth_number(kCurveSamples / 2. * finest);
    RandomStream random(input_.sampling.seed, "curves");
    const auto curve = [&](const std::string& name, const Eigen::Vector2d& from,
                           const Eigen::Vector2d& along) {
      const double points = grid_ ? *grid_ : 2 * half * along.sum();
      if (points > kMostCurvePoints) return;
      Eigen::MatrixX2d at(static_cast<Eigen::Index>(points), 2);
      for (Eigen::Index i = 0; i < at.rows(); ++i)
        at.row(i) = from + along * (static_cast<double>(i) / points);
      add(plan, name, plan.corrugations, std::move(at));
    };
    const auto place = [&] {
      const double x = known(random.uniform());
      return Eigen::Vector2d(x, known(random.uniform()));
    };
    const Eigen::Vector2d from = place();
    curve("horizontal", from, {1, 0});
    curve("vertical", place(), {0, 1});
    curve("diagonal", place(), {1, 2});
    const double step = 1 / (2 * half);
    curve("horizontal_above", {from.x(), from.y() + step}, {1, 0});
    curve("horizontal_below", {from.x(), from.y() - step}, {1, 0});
  }

  const TorusInput& input_;
  std::optional<int> grid_;
};

}  // namespace

Eigen::MatrixX2d WindowSet::parameters() const {
  Eigen::MatrixX2d at(corner.rows() * side * side, 2);
  Eigen::Index row = 0;
  for (Eigen::Index w = 0; w < corner.rows(); ++w)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i)
        at.row(row++) << corner(w, 0) + step * i, corner(w, 1) + step * j;
  return at;
}

double finest_periods(const TorusInput& input, int corrugations) {
  double most = 1;
  for (int i = 0; i < corrugations; ++i) {
    const Corrugation& c = input.corrugations[i];
    most = std::max(most, c.number * kDirections[c.direction].covector.norm());
  }
  return most;
}

int grid_node(double parameter, int n) {
  const auto i = static_cast<int>(std::llround(parameter * n) % n);
  return i < 0 ? i + n : i;
}

std::vector<FramePlan> plan_frames(const TorusInput& input, std::optional<int> grid) {
  const FramePlanner planner(input, grid);
  std::vector<FramePlan> plans;
  if (input.sampling.zooms) {
    for (int number = 0; number < *input.sampling.zooms; ++number)
      plans.push_back(planner.of_view(number));
  } else {
    for (int count = 0; count <= std::ssize(input.corrugations); ++count)
      plans.push_back(planner.of_corrugation(count));
  }
  if (input.sampling.whole) planner.add_whole(plans.back(), *input.sampling.whole);
  return plans;
}

}  // namespace geoprior::torus
