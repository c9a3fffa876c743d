#include "solvers/fluid/lift/moving_frame.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace geoprior::fluid {
namespace {

/// A feature travels when its way is longer than this share of its size.
constexpr double kTravel = 0.5;
/// Slower than this share of its mean speed, its direction is that of the frame before.
constexpr double kRest = 0.1;

/// Value and rate of a fitted parabola.
struct Fit {
  Eigen::Vector3d value, rate;
};

/// Least-squares parabola (line, constant when there are too few) through samples near a frame.
template <class Quantity>
Fit fit_at(const std::vector<FrameSample>& samples, const FrameTime& at, int window,
           const Quantity& quantity) {
  std::vector<const FrameSample*> used;
  for (const FrameSample& s : samples) {
    if (2 * std::abs(s.frame - at.frame) < window) used.push_back(&s);
  }
  const bool inside = std::any_of(used.begin(), used.end(),
                                  [&](const FrameSample* s) { return s->frame <= at.frame; }) &&
                      std::any_of(used.begin(), used.end(),
                                  [&](const FrameSample* s) { return s->frame >= at.frame; });
  if (!inside) {  // a gap wider than the window: from the samples beside it
    const auto after = std::find_if(samples.begin(), samples.end(),
                                    [&](const FrameSample& s) { return s.frame >= at.frame; });
    used.clear();
    if (after != samples.begin()) used.push_back(&*(after - 1));
    if (after != samples.end()) used.push_back(&*after);
  }
  const Eigen::Index m = used.size();
  const Eigen::Index terms = std::min<Eigen::Index>(3, m);
  Eigen::MatrixXd A(m, terms);
  Eigen::MatrixX3d b(m, 3);
  const double unit = std::max(1e-12, used.back()->time - used.front()->time);
  // About a sample's value: constants pass without round-off.
  const Eigen::Vector3d origin = quantity(*used.front());
  for (Eigen::Index i = 0; i < m; ++i) {
    const FrameSample& s = *used[i];
    for (Eigen::Index k = 0; k < terms; ++k) {
      A(i, k) = std::pow((s.time - at.time) / unit, static_cast<double>(k));
    }
    b.row(i) = (quantity(s) - origin).transpose();
  }
  const Eigen::MatrixXd x = A.colPivHouseholderQr().solve(b);
  Fit fit{origin + x.row(0).transpose(), Eigen::Vector3d::Zero()};
  if (terms > 1) fit.rate = x.row(1).transpose() / unit;
  return fit;
}

Eigen::Vector3d across(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal) {
  return direction - direction.dot(normal) * normal;
}

/// The longest axis of all frames together, across the mean normal.
Eigen::Vector3d longest_axis(const std::vector<FrameSample>& samples, const Eigen::Vector3d& normal,
                             const Eigen::Vector3d& way) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const FrameSample& s : samples) sum += s.covariance;
  const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - normal * normal.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(flat * sum * flat);
  Eigen::Vector3d axis = across(eigen.eigenvectors().col(2), normal);
  if (axis.norm() < 0.5) axis = across(normal.unitOrthogonal(), normal);
  axis.normalize();
  return axis.dot(way) < 0 ? Eigen::Vector3d(-axis) : axis;
}

Eigen::Isometry3d frame_of(const Eigen::Vector3d& origin, const Eigen::Vector3d& x,
                           const Eigen::Vector3d& z) {
  Eigen::Isometry3d frame = Eigen::Isometry3d::Identity();
  frame.linear().col(0) = x;
  frame.linear().col(1) = z.cross(x);
  frame.linear().col(2) = z;
  frame.translation() = origin;
  return frame;
}

const auto kCentre = [](const FrameSample& s) -> Eigen::Vector3d { return s.centre; };
const auto kNormal = [](const FrameSample& s) -> Eigen::Vector3d { return s.normal; };

/// x directions of a feature that travels; where it rests, that of the frame before (at the start:
/// of the first that moves).
std::vector<Eigen::Vector3d> path_directions(const std::vector<FrameSample>& samples,
                                             const std::vector<FrameTime>& times, int window,
                                             double mean_speed, const Eigen::Vector3d& way) {
  std::vector<Eigen::Vector3d> result(times.size(), Eigen::Vector3d::Zero());
  Eigen::Vector3d last = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Eigen::Vector3d rate = fit_at(samples, times[i], 3 * window, kCentre).rate;
    if (rate.norm() > kRest * mean_speed) last = rate;
    result[i] = last;
  }
  last = way;
  for (std::size_t i = times.size(); i-- > 0;) {
    if (result[i].isZero(0)) result[i] = last;
    last = result[i];
  }
  return result;
}

}  // namespace

std::vector<Eigen::Isometry3d> moving_frames(const std::vector<FrameSample>& samples,
                                             const std::vector<FrameTime>& times, int window) {
  Eigen::Vector3d mean_normal = Eigen::Vector3d::Zero();
  double area = 0, length = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    mean_normal += samples[i].normal;
    area += samples[i].area / static_cast<double>(samples.size());
    if (i > 0) length += (samples[i].centre - samples[i - 1].centre).norm();
  }
  mean_normal.normalize();
  const Eigen::Vector3d way = samples.back().centre - samples.front().centre;
  std::vector<Eigen::Vector3d> x(times.size());
  if (way.norm() > kTravel * std::sqrt(area)) {
    const double speed = length / (samples.back().time - samples.front().time);
    x = path_directions(samples, times, window, speed, way);
  } else {
    std::fill(x.begin(), x.end(), longest_axis(samples, mean_normal, way));
  }
  std::vector<Eigen::Isometry3d> result;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Eigen::Vector3d z = fit_at(samples, times[i], window, kNormal).value.normalized();
    Eigen::Vector3d e = across(x[i].normalized(), z);
    if (e.norm() < 1e-6) {
      e = across(result.empty() ? z.unitOrthogonal() : result.back().linear().col(0), z);
    }
    result.push_back(frame_of(fit_at(samples, times[i], window, kCentre).value, e.normalized(), z));
  }
  return result;
}

std::vector<Eigen::Isometry3d> moving_centres(const std::vector<FrameSample>& samples,
                                              const std::vector<FrameTime>& times, int window) {
  std::vector<Eigen::Isometry3d> result;
  for (const FrameTime& t : times) {
    result.push_back(frame_of(fit_at(samples, t, window, kCentre).value, Eigen::Vector3d::UnitX(),
                              Eigen::Vector3d::UnitZ()));
  }
  return result;
}

}  // namespace geoprior::fluid
