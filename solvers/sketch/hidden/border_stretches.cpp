#include "solvers/sketch/hidden/border_stretches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace geoprior::sketch {

double stretch_length(const Stretch& stretch) {
  double sum = 0;
  for (std::size_t i = 1; i < stretch.size(); ++i) sum += (stretch[i].p - stretch[i - 1].p).norm();
  return sum;
}

PictureCurve picture_of(const Stretch& stretch, bool closed) {
  PictureCurve curve{{}, closed};
  for (const BorderPoint& b : stretch) curve.points.push_back(b.p);
  return curve;
}

Eigen::Vector2d direction_out(const Stretch& stretch, bool at_back, double part) {
  const auto at = [&](std::size_t k) -> const Eigen::Vector2d& {
    return stretch[at_back ? stretch.size() - 1 - k : k].p;
  };
  std::size_t k = 1;
  double way = 0;
  while (k < stretch.size() && way < part) {
    way += (at(k) - at(k - 1)).norm();
    ++k;
  }
  // Middles of both halves of the part, so that one trembling point does not decide.
  Eigen::Vector2d near(0, 0), far(0, 0);
  const std::size_t half = std::max<std::size_t>(k / 2, 1);
  for (std::size_t i = 0; i < half; ++i) near += at(i) / static_cast<double>(half);
  for (std::size_t i = k - half; i < k; ++i) far += at(i) / static_cast<double>(half);
  return (near - far).normalized();
}

std::vector<PlacedStretch> placed_along(const PictureCurve& model,
                                        const std::vector<Stretch>& stretches) {
  const double around = static_cast<double>(model.points.size());
  const auto ahead = [&](double a, double b) {
    return b - a - around * std::floor((b - a) / around);
  };
  std::vector<PlacedStretch> placed;
  for (const Stretch& stretch : stretches) {
    PlacedStretch p{nearest_place(model, stretch.front().p).at,
                    nearest_place(model, stretch.back().p).at, false, stretch};
    // The way from begin over the middle to the end tells the sense around a closed model.
    const double middle = nearest_place(model, stretch[stretch.size() / 2].p).at;
    p.turned = model.closed ? ahead(p.begin, middle) > ahead(p.begin, p.end) : p.end < p.begin;
    if (p.turned) std::swap(p.begin, p.end);
    if (p.turned) std::reverse(p.stretch.begin(), p.stretch.end());
    if (model.closed) p.end = p.begin + ahead(p.begin, p.end);
    placed.push_back(std::move(p));
  }
  std::stable_sort(
      placed.begin(), placed.end(),
      [](const PlacedStretch& a, const PlacedStretch& b) { return a.begin < b.begin; });
  return placed;
}

double length_between(const PictureCurve& curve, double a, double b) {
  double sum = 0;
  Eigen::Vector2d before = point_at(curve, a);
  for (double k = std::floor(a) + 1; k < b; k += 1) {
    const Eigen::Vector2d p = point_at(curve, k);
    sum += (p - before).norm();
    before = p;
  }
  return sum + (point_at(curve, b) - before).norm();
}

void FollowedModel::fill(double a, double b, const std::optional<Eigen::Vector2d>& at_a,
                         const std::optional<Eigen::Vector2d>& at_b) {
  const Eigen::Vector2d zero(0, 0);
  const Eigen::Vector2d da = at_a ? Eigen::Vector2d(*at_a - point_at(model, a)) : zero;
  const Eigen::Vector2d db = at_b ? Eigen::Vector2d(*at_b - point_at(model, b)) : zero;
  Stretch guess;
  for (double k = at_a ? std::floor(a) + 1 : a; at_b ? k < b : k <= b + 1e-9; k += 1) {
    const double t = b > a ? (k - a) / (b - a) : 0;
    guess.push_back({point_at(model, k) + (1 - t) * da + t * db, {}});
  }
  if (at_a && !guess.empty()) added += (guess.front().p - *at_a).norm();
  if (at_b && !guess.empty()) added += (guess.back().p - *at_b).norm();
  added += stretch_length(guess);
  points.insert(points.end(), guess.begin(), guess.end());
}

}  // namespace geoprior::sketch
