#include "experiments/skinning/scene/guess/hand.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace geoprior::skinning {
namespace {

using Eigen::Vector3d;

constexpr double kWidth = 0.15;     ///< of the knuckles (deviation), over their distance
constexpr double kThick = 0.5;      ///< of the knuckles across their line, over their width
constexpr double kTogether = 0.64;  ///< cosine of 50 degrees between a finger and the mean
constexpr double kThumb = 0.82;     ///< cosine of 35 degrees
constexpr double kBent = 0.07;      ///< rad, of a finger
constexpr double kOneSide = 2.0 / 3;

using Chains = std::vector<std::vector<int>>;

Vector3d pointing(const Skeleton& skeleton, int hand, const std::vector<int>& chain) {
  return (skeleton.joints[chain.back()].head - skeleton.joints[hand].head).stableNormalized();
}

/// Unit mean of where the chains point but for one of them, a thumb's; zero where they are none of
/// a hand's.
Vector3d common_direction(const Skeleton& skeleton, int hand, const Chains& chains) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& chain : chains) sum += pointing(skeleton, hand, chain);
  Vector3d aside = pointing(skeleton, hand, chains[0]);
  for (const auto& chain : chains) {
    const Vector3d finger = pointing(skeleton, hand, chain);
    if (sum.dot(finger) < sum.dot(aside)) aside = finger;
  }
  const Vector3d mean = (sum - aside).stableNormalized();
  int spread = 0;
  for (const auto& chain : chains) {
    const double cosine = mean.dot(pointing(skeleton, hand, chain));
    if (cosine < 0) return Vector3d::Zero();
    spread += cosine < kTogether;
  }
  return spread <= 1 ? mean : Vector3d::Zero();
}

/// The direction in which the first joints of fingers lie side by side; zero where they lie behind
/// one another, or in two rows.
Vector3d knuckle_line(const Skeleton& skeleton, int hand, const Chains& chains,
                      const Vector3d& bone) {
  Vector3d mean = Vector3d::Zero();
  for (const auto& chain : chains) mean += skeleton.joints[chain[0]].head;
  mean /= static_cast<double>(chains.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& chain : chains) {
    const Vector3d from_mean = skeleton.joints[chain[0]].head - mean;
    const Vector3d across = from_mean - from_mean.dot(bone) * bone;
    spread += across * across.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(spread);
  const Vector3d widths =
      (axes.eigenvalues().cwiseMax(0) / static_cast<double>(chains.size())).cwiseSqrt();
  const bool is_wide = widths[2] > kWidth * (mean - skeleton.joints[hand].head).norm();
  const bool is_line = widths[1] < kThick * widths[2];
  return is_wide && is_line ? Vector3d(axes.eigenvectors().col(2)) : Vector3d::Zero();
}

/// Radians by which the bones of a finger turn about an axis from one to the next.
double bend_about(const Vector3d& axis, const Skeleton& skeleton, const std::vector<int>& chain) {
  double sum = 0;
  for (std::size_t i = 0; i + 2 < chain.size(); ++i) {
    const auto head = [&](std::size_t k) { return skeleton.joints[chain[k]].head; };
    const Vector3d before = (head(i + 1) - head(i)).stableNormalized();
    const Vector3d after = (head(i + 2) - head(i + 1)).stableNormalized();
    sum += std::asin(std::clamp(axis.dot(before.cross(after)), -1.0, 1.0));
  }
  return sum;
}

std::optional<Vector3d> closing_axis(const Hand& hand, const Skeleton& skeleton,
                                     const Chains& chains) {
  double sum = 0, all = 0;
  for (const auto& chain : chains) {
    if (is_thumb(hand, skeleton, chain)) continue;
    const double bend = bend_about(hand.knuckles, skeleton, chain);
    sum += bend;
    all += std::abs(bend);
  }
  const bool is_bent = all > kBent * static_cast<double>(chains.size() - 1);
  if (!is_bent || std::abs(sum) < kOneSide * all) return std::nullopt;
  return Vector3d(std::copysign(1.0, sum) * hand.knuckles);
}

}  // namespace

std::vector<int> chain_from(int joint, const std::vector<std::vector<int>>& children) {
  std::vector<int> chain{joint};
  while (children[chain.back()].size() == 1) chain.push_back(children[chain.back()][0]);
  return chain;
}

bool is_thumb(const Hand& hand, const Skeleton& skeleton, const std::vector<int>& chain) {
  return hand.direction.dot(pointing(skeleton, hand.joint, chain)) < kThumb;
}

std::optional<Hand> find_hand(const Skeleton& skeleton,
                              const std::vector<std::vector<int>>& children, int joint,
                              const Eigen::Vector3d& bone) {
  if (children[joint].size() < 3) return std::nullopt;
  Chains chains;
  Hand hand{joint, {}, {}, 0, {}};
  for (const int child : children[joint]) {
    chains.push_back(chain_from(child, children));
    const int end = chains.back().back();
    if (!children[end].empty()) return std::nullopt;
    hand.reach =
        std::max(hand.reach, (skeleton.joints[end].head - skeleton.joints[joint].head).norm());
  }
  hand.direction = common_direction(skeleton, joint, chains);
  hand.knuckles = knuckle_line(skeleton, joint, chains, bone);
  if (hand.direction.isZero() || hand.knuckles.isZero()) return std::nullopt;
  hand.closing = closing_axis(hand, skeleton, chains);
  return hand;
}

}  // namespace geoprior::skinning
