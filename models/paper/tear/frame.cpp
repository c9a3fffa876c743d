#include "models/paper/tear/frame.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/angles.h"
#include "models/paper/contact/segments.h"
#include "models/paper/tear/lip_detail.h"
#include "models/paper/tear/lip_places.h"

namespace geoprior::paper {
namespace {

using Eigen::Vector2d;

Part tears_part(const Tears& tears, const ShellState& state) {
  const LipPlaces places(state, width(tears.torn()));
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
        points.push_back(places.in_space(places.on_lip(tear.path[i], perpendicular(along), lip)));
        values.push_back({tear.path[i].x(), tear.path[i].y(), tear.times[i], static_cast<double>(t),
                          static_cast<double>(lip)});
      }
    }
  }
  const Eigen::Index rows = points.size();
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
  if (growth.detail().on)
    add_lip_detail(growth.tears(), growth.detail(), growth.seed(), state, frame);
  const TearGrowth::Totals& totals = growth.totals();
  frame.diagnostics["tears"] = static_cast<double>(growth.tears().torn().cuts.size());
  frame.diagnostics["tear_length"] = growth.tears().length();
  frame.diagnostics["tear_energy"] = totals.energy;
  frame.diagnostics["tear_released"] = totals.released;
  frame.diagnostics["tear_steps"] = totals.steps;
  frame.diagnostics["tears_given_up"] = totals.given_up;
  frame.diagnostics["tear_candidates"] = totals.tested;
  frame.diagnostics["tear_force"] = growth.last_pull().force;
  frame.diagnostics["tear_angle"] = growth.last_pull().angle / kDegree;
}

}  // namespace geoprior::paper
