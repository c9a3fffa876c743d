#include "metrics/tracks/velocity_jump.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

void require_motion(const SampledMotion& motion) {
  if (motion.parameters.size() != motion.x.size())
    throw Error(std::to_string(motion.x.size()) + " samples at " +
                    std::to_string(motion.parameters.size()) + " parameters",
                "velocity jump", "as many of both");
  for (std::size_t i = 1; i < motion.x.size(); ++i) {
    if (!(motion.parameters[i - 1] < motion.parameters[i]))
      throw Error("parameters do not ascend", "sample " + std::to_string(i));
    if (motion.x[i].rows() != motion.x[0].rows() || motion.x[i].cols() != motion.x[0].cols())
      throw Error("another size than the first sample's", "sample " + std::to_string(i));
  }
}

const Eigen::MatrixXd* sample_at(const SampledMotion& motion, double parameter, double tolerance) {
  const auto first =
      std::lower_bound(motion.parameters.begin(), motion.parameters.end(), parameter - tolerance);
  if (first == motion.parameters.end() || *first > parameter + tolerance) return nullptr;
  return &motion.x[first - motion.parameters.begin()];
}

}  // namespace

double mean_speed(const SampledMotion& motion) {
  require_motion(motion);
  if (motion.x.size() < 2 || motion.x[0].rows() == 0) return 0;
  double way = 0;
  for (std::size_t i = 1; i < motion.x.size(); ++i)
    way += (motion.x[i] - motion.x[i - 1]).rowwise().norm().mean();
  return way / (motion.parameters.back() - motion.parameters.front());
}

std::optional<double> velocity_jump(const SampledMotion& motion, double at, double step) {
  require_motion(motion);
  if (!(step > 0)) throw Error("the step is not positive", "velocity jump");
  std::array<const Eigen::MatrixXd*, 5> x{};
  for (int k = -2; k <= 2; ++k) {
    x[k + 2] = sample_at(motion, at + k * step, 1e-6 * step);
    if (x[k + 2] == nullptr) return std::nullopt;
  }
  if (x[2]->rows() == 0) return 0;
  // Differences first: places may be large beside the way of a step.
  const Eigen::MatrixXd after = 4 * (*x[3] - *x[2]) - (*x[4] - *x[2]);
  const Eigen::MatrixXd before = 4 * (*x[2] - *x[1]) - (*x[2] - *x[0]);
  return (after - before).rowwise().norm().maxCoeff() / (2 * step);
}

std::optional<double> relative_velocity_jump(const SampledMotion& motion,
                                             std::span<const double> at, double step) {
  std::optional<double> worst;
  for (const double parameter : at) {
    const auto jump = velocity_jump(motion, parameter, step);
    if (jump) worst = std::max(worst.value_or(0), *jump);
  }
  if (!worst || *worst == 0) return worst;
  return *worst / mean_speed(motion);
}

}  // namespace geoprior
