#include "baselines/grammar/regeneration.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"

namespace geoprior::grammar {
namespace {

constexpr double kLeastStretch = 0.2, kMostStretch = 5;

/// Key points before and after, as columns, and their weights.
struct KeyPairs {
  Eigen::Matrix3Xd from, to;
  Eigen::VectorXd weight;
};

KeyPairs key_pairs(const Hierarchy& rest, const SpatialMap& map) {
  std::vector<Eigen::Vector3d> keys;
  std::vector<double> weights;
  for (int e = 0; e < rest.size(); ++e) {
    if (!rest.present(e)) continue;
    const std::size_t first = keys.size();
    rest.keys(e, keys);
    const std::size_t count = keys.size() - first;
    weights.insert(weights.end(), count, 1. / static_cast<double>(count));
  }
  const int n = static_cast<int>(keys.size());
  KeyPairs pairs{Eigen::Matrix3Xd(3, n), Eigen::Matrix3Xd(3, n), Eigen::VectorXd(n)};
  for (int k = 0; k < n; ++k) {
    pairs.from.col(k) = keys[k];
    pairs.to.col(k) = map.at(keys[k]);
    pairs.weight[k] = weights[k];
  }
  return pairs;
}

double clamped_stretch(double amount, double sum) {
  return sum > 0 ? std::clamp(amount / sum, kLeastStretch, kMostStretch) : 1;
}

/// Of (cos, sin): the first eigenvector of a symmetric matrix.
Eigen::Vector2d first_axis(double xx, double xy, double yy) {
  const double angle = std::atan2(2 * xy, xx - yy) / 2;
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

StretchFit fit_stretch(const Hierarchy& rest, const SpatialMap& map) {
  const KeyPairs pairs = key_pairs(rest, map);
  if (pairs.weight.size() == 0)
    throw Error("has no key points", "object that is made again", "at least one");
  StretchFit fit;
  fit.position = rest.position(0);
  if (pairs.from == pairs.to) return fit;
  const double total = pairs.weight.sum();
  const Eigen::Vector3d from_mean = pairs.from * pairs.weight / total;
  const Eigen::Vector3d to_mean = pairs.to * pairs.weight / total;
  const Eigen::Matrix3Xd x = pairs.from.colwise() - from_mean;
  const Eigen::Matrix3Xd u = pairs.to.colwise() - to_mean;
  const Eigen::Matrix3d cross = x * pairs.weight.asDiagonal() * u.transpose();
  const Eigen::Vector3d sum = x.array().square().matrix() * pairs.weight;
  const double fx = sum.x() > 0 ? 1 / sum.x() : 0, fy = sum.y() > 0 ? 1 / sum.y() : 0;
  const double xu = cross(0, 0), xv = cross(0, 1), yu = cross(1, 0), yv = cross(1, 1);
  Eigen::Vector2d turn = first_axis(fx * xu * xu + fy * yv * yv, fx * xu * xv - fy * yu * yv,
                                    fx * xv * xv + fy * yu * yu);
  const auto along_x = [&] { return turn.x() * xu + turn.y() * xv; };
  const auto along_y = [&] { return turn.x() * yv - turn.y() * yu; };
  if (along_x() * fx + along_y() * fy < 0) turn = -turn;
  fit.yaw = std::atan2(turn.y(), turn.x());
  fit.stretch = {clamped_stretch(along_x(), sum.x()), clamped_stretch(along_y(), sum.y()),
                 clamped_stretch(cross(2, 2), sum.z())};
  const Eigen::AngleAxisd yaw(fit.yaw, Eigen::Vector3d::UnitZ());
  fit.position = to_mean - yaw * fit.stretch.cwiseProduct(from_mean - rest.position(0));
  return fit;
}

Hierarchy regenerate(const Hierarchy& rest,
                     const std::function<Hierarchy(const Eigen::Vector3d& stretch)>& generate,
                     const SpatialMap& map) {
  const StretchFit fit = fit_stretch(rest, map);
  Hierarchy made = generate(fit.stretch);
  const Eigen::Vector3d root = made.position(0);
  const Eigen::Quaterniond yaw(Eigen::AngleAxisd(fit.yaw, Eigen::Vector3d::UnitZ()));
  for (int e = 0; e < made.size(); ++e) {
    made.set_pose(e, {fit.position + yaw * (made.position(e) - root), yaw * made.turn(e)});
    for (Eigen::Vector3d& x : made.points(e)) x = fit.position + yaw * (x - root);
  }
  return made;
}

}  // namespace geoprior::grammar
