#include "models/paper/tear_frame.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/angles.h"
#include "models/paper/pattern_locator.h"
#include "models/paper/segments.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

/// How far beside a lip the sheet is surely on its side, over the size of the pattern.
constexpr double kBeside = 1e-3;

/// Place in space of a point of a lip.
Eigen::RowVector3d on_lip(const ShellState& state, const PatternLocator& locator, const Vector2d& p,
                          const Vector2d& beside) {
  const PatternLocator::Place at = locator.locate(p, beside);
  Eigen::RowVector3d x = Eigen::RowVector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    x += at.weights[k] * state.x.row(state.mesh.triangles(at.triangle, k));
  }
  return x;
}

Part tears_part(const Tears& tears, const ShellState& state) {
  const PatternLocator locator(state.mesh);
  const double offset = kBeside * width(tears.torn());
  std::vector<Eigen::RowVector3d> points;
  std::vector<std::array<double, 5>> values;  // pattern, time, tear, lip
  Part part;
  part.kind = Part::Kind::lines;
  for (std::size_t t = 0; t < tears.all().size(); ++t) {
    const Tear& tear = tears.all()[t];
    const std::size_t n = tear.path.size();
    if (n < 2) continue;
    for (const int lip : {0, 1}) {
      std::vector<int>& line = part.lines.emplace_back(n);
      std::iota(line.begin(), line.end(), static_cast<int>(points.size()));
      for (std::size_t i = 0; i < n; ++i) {
        const Vector2d along =
            (tear.path[std::min(i + 1, n - 1)] - tear.path[i == 0 ? 0 : i - 1]).normalized();
        const Vector2d beside = (lip == 0 ? offset : -offset) * perpendicular(along);
        points.push_back(on_lip(state, locator, tear.path[i], tear.path[i] + beside));
        values.push_back({tear.path[i].x(), tear.path[i].y(), tear.times[i], static_cast<double>(t),
                          static_cast<double>(lip)});
      }
    }
  }
  const auto rows = static_cast<Eigen::Index>(points.size());
  part.points.resize(rows, 3);
  Eigen::MatrixXd pattern(rows, 2), time(rows, 1), number(rows, 1), lip(rows, 1);
  for (Eigen::Index i = 0; i < rows; ++i) {
    part.points.row(i) = points[i];
    const auto& v = values[i];
    pattern.row(i) << v[0], v[1];
    time(i, 0) = v[2];
    number(i, 0) = v[3];
    lip(i, 0) = v[4];
  }
  using On = NamedArray::On;
  part.arrays.push_back({"pattern", "m", On::points, pattern});
  part.arrays.push_back({"time", "s", On::points, time});
  part.arrays.push_back({"tear", "1", On::points, number});
  part.arrays.push_back({"lip", "1", On::points, lip});
  return part;
}

}  // namespace

void add_tears(const TearGrowth& growth, const ShellState& state, Frame& frame) {
  frame.parts["tears"] = tears_part(growth.tears(), state);
  const TearGrowth::Totals& totals = growth.totals();
  frame.diagnostics["tears"] = static_cast<double>(growth.tears().torn().cuts.size());
  frame.diagnostics["tear_length"] = growth.tears().length();
  frame.diagnostics["tear_energy"] = totals.energy;
  frame.diagnostics["tear_released"] = totals.released;
  frame.diagnostics["tear_steps"] = totals.steps;
  frame.diagnostics["tear_candidates"] = totals.tested;
  frame.diagnostics["tear_force"] = growth.last_pull().force;
  frame.diagnostics["tear_angle"] = growth.last_pull().angle / kDegree;
}

}  // namespace geoprior::paper
