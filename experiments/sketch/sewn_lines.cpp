#include "experiments/sketch/sewn_lines.h"

#include <algorithm>
#include <map>

namespace geoprior::sketch {
namespace {

Eigen::MatrixX2d flat_line(const Part& pattern, const std::vector<int>& points) {
  Eigen::MatrixX2d line(points.size(), 2);
  for (std::size_t i = 0; i < points.size(); ++i)
    line.row(i) = pattern.points.row(points[i]).head<2>();
  return line;
}

}  // namespace

std::vector<std::array<Eigen::MatrixX2d, 2>> sewn_lines(const Frame& frame) {
  const FrameTable& sewn = frame.require_table("sewn");
  const Part& pattern = frame.require_part("pattern");
  std::map<int, std::vector<int>> points;
  std::map<int, int> partner;
  for (Eigen::Index i = 0; i < sewn.rows.rows(); ++i) {
    const int stretch = static_cast<int>(sewn.rows(i, 0));
    points[stretch].push_back(static_cast<int>(sewn.rows(i, 3)));
    partner[stretch] = static_cast<int>(sewn.rows(i, 1));
  }
  std::vector<std::array<Eigen::MatrixX2d, 2>> lines;
  for (const auto& [stretch, other] : partner) {
    if (stretch >= other) continue;  // the two sides of a dart included: each pair once
    std::vector<int> reversed = points.at(other);
    std::reverse(reversed.begin(), reversed.end());
    lines.push_back({flat_line(pattern, points.at(stretch)), flat_line(pattern, reversed)});
  }
  return lines;
}

}  // namespace geoprior::sketch
