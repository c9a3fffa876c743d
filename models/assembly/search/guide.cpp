#include "models/assembly/search/guide.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include "core/error.h"
#include "models/assembly/graph/labels.h"

namespace geoprior::assembly {

void describe(OptionVisitor& v, Target& options) {
  constexpr std::array<std::string_view, 2> kKinds = {"outline", "region"};
  describe_choice(v, "kind", options.kind, kKinds,
                  {.doc = "whether ways follow the closed poly-line or fill its inside"});
  v.value("x", options.x, {.doc = "x of the corners of the closed poly-line", .unit = "m"});
  v.value("y", options.y, {.doc = "y of the corners of the closed poly-line", .unit = "m"});
  v.value("spacing", options.spacing,
          {.doc = "distance of the points at which ways and target are compared",
           .unit = "m",
           .min = 1e-6});
}

void describe(OptionVisitor& v, Guide& options) {
  describe_group(v, "target", options.target,
                 {.doc = "where the ways are to be in plan; absent: anywhere"});
  v.value("keep", options.keep, {.doc = "labels of parts that no replacement removes"});
  v.value("use", options.use, {.doc = "labels of parts of which at least one is wanted"});
}

void require_valid(const Guide& guide, const std::string& where) {
  if (!guide.target) return;
  if (guide.target->x.size() != guide.target->y.size())
    throw Error("has " + std::to_string(guide.target->x.size()) + " x and " +
                    std::to_string(guide.target->y.size()) + " y",
                where + ".target", "one y for each x");
  if (guide.target->x.size() < 3)
    throw Error("has " + std::to_string(guide.target->x.size()) + " corners", where + ".target",
                "3 or more");
}

namespace {

using Points = std::vector<Eigen::Vector2d>;

/// Points along a poly-line, at most `spacing` apart.
template <class Vector>
std::vector<Vector> resampled(const std::vector<Vector>& line, double spacing) {
  std::vector<Vector> out;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const int n =
        std::max(1, static_cast<int>(std::ceil((line[i + 1] - line[i]).norm() / spacing)));
    for (int k = 0; k < n; ++k)
      out.push_back(line[i] + (line[i + 1] - line[i]) * (static_cast<double>(k) / n));
  }
  if (!line.empty()) out.push_back(line.back());
  return out;
}

double mean_nearest(const Points& from, const Points& to) {
  double sum = 0;
  for (const Eigen::Vector2d& x : from) {
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& y : to) least = std::min(least, (x - y).squaredNorm());
    sum += std::sqrt(least);
  }
  return sum / static_cast<double>(from.size());
}

}  // namespace

Objective::Objective(const Guide& guide, const std::vector<PartType>& types)
    : target_(guide.target), kept_(types.size(), 0) {
  const double spacing = target_ ? target_->spacing : 1;
  for (std::size_t t = 0; t < types.size(); ++t) {
    std::vector<Eigen::Vector3d>& points = samples_.emplace_back();
    for (const Way& way : types[t].ways) {
      const auto more = resampled(way.points, spacing);
      points.insert(points.end(), more.begin(), more.end());
    }
    if (types[t].ways.empty())
      for (const PortType& port : types[t].ports) points.push_back(port.frame.translation());
    kept_[t] = is_among(guide.keep, types[t].label);
  }
  for (const std::string& name : guide.use) {
    std::vector<int>& meant = wanted_.emplace_back();
    for (std::size_t t = 0; t < types.size(); ++t)
      if (is_meant(name, types[t].label)) meant.push_back(static_cast<int>(t));
  }
  if (!target_) return;
  for (std::size_t i = 0; i < target_->x.size(); ++i)
    corners_.emplace_back(target_->x[i], target_->y[i]);
  Points closed = corners_;
  closed.push_back(corners_.front());
  target_points_ = resampled(closed, spacing);
  if (target_->kind == Target::Kind::outline) return;
  const auto [left, right] = std::minmax_element(target_->x.begin(), target_->x.end());
  const auto [bottom, top] = std::minmax_element(target_->y.begin(), target_->y.end());
  target_points_.clear();
  for (double y = *bottom + spacing / 2; y < *top; y += spacing)
    for (double x = *left + spacing / 2; x < *right; x += spacing)
      if (is_inside({x, y})) target_points_.emplace_back(x, y);
}

bool Objective::is_inside(const Eigen::Vector2d& x) const {
  bool inside = false;
  for (std::size_t i = 0, j = corners_.size() - 1; i < corners_.size(); j = i++) {
    const Eigen::Vector2d &a = corners_[i], &b = corners_[j];
    if ((a.y() > x.y()) != (b.y() > x.y()) &&
        x.x() < (b.x() - a.x()) * (x.y() - a.y()) / (b.y() - a.y()) + a.x())
      inside = !inside;
  }
  return inside;
}

Points Objective::plan_points(const Assembly& assembly) const {
  Points out;
  for (const PlacedPart& part : assembly.parts)
    for (const Eigen::Vector3d& x : samples_[part.type]) out.push_back((part.pose * x).head<2>());
  return out;
}

double Objective::outline_distance(const Points& points) const {
  return (mean_nearest(points, target_points_) + mean_nearest(target_points_, points)) / 2;
}

double Objective::region_miss(const Points& points) const {
  const auto near = [&](const Eigen::Vector2d& x) {
    return std::any_of(points.begin(), points.end(), [&](const Eigen::Vector2d& y) {
      return (x - y).norm() <= target_->spacing;
    });
  };
  const auto missed = std::count_if(target_points_.begin(), target_points_.end(),
                                    [&](const Eigen::Vector2d& x) { return !near(x); });
  const auto outside = std::count_if(points.begin(), points.end(),
                                     [&](const Eigen::Vector2d& x) { return !is_inside(x); });
  return static_cast<double>(missed) / static_cast<double>(target_points_.size()) +
         static_cast<double>(outside) / static_cast<double>(points.size());
}

double Objective::operator()(const Assembly& assembly) const {
  double value = 0;
  for (const std::vector<int>& meant : wanted_)
    value +=
        std::none_of(assembly.parts.begin(), assembly.parts.end(), [&](const PlacedPart& part) {
          return std::find(meant.begin(), meant.end(), part.type) != meant.end();
        });
  if (!target_) return value;
  const Points points = plan_points(assembly);
  if (points.empty() || target_points_.empty()) return value + 1;
  return value +
         (target_->kind == Target::Kind::outline ? outline_distance(points) : region_miss(points));
}

}  // namespace geoprior::assembly
