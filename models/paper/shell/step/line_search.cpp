#include "models/paper/shell/step/line_search.h"

#include <cmath>
#include <limits>

namespace geoprior::paper {
namespace {

/// Part of the decrease that the slope promises which a step must keep (Armijo).
constexpr double kLeastDecrease = 1e-4;
constexpr int kMostBacktracks = 20;
/// Of the value: what rounding may leave of a decrease.
constexpr double kNoise = 64 * std::numeric_limits<double>::epsilon();

}  // namespace

bool find_direction(const Eigen::VectorXd& gradient, StepMatrix& matrix, SecantPairs& secants,
                    Eigen::VectorXd& direction) {
  const auto solve = [&](Eigen::VectorXd& b) { return matrix.solve(b); };
  direction = -gradient;
  if (!secants.apply(direction, solve)) return false;
  if (gradient.dot(direction) < 0) return true;
  secants.clear();
  direction = -gradient;
  return solve(direction);
}

double search_line(const StepMatrix& rows, const Eigen::VectorXd& direction, double slope,
                   StepPotential& potential, const LineStart& at, Eigen::MatrixX3d& trial) {
  const double noise = kNoise * std::abs(at.value);
  double length = 1;
  for (int k = 0; k < kMostBacktracks; ++k, length /= 2) {
    trial = at.x;
    for (int i = 0; i < trial.rows(); ++i) {
      trial.row(i) += length * direction.segment<3>(rows.row(i)).transpose();
    }
    const double tried = potential.value(trial);
    if (!(tried <= at.value + kLeastDecrease * length * slope + noise)) continue;
    at.x.swap(trial);
    at.value = tried;
    return length;
  }
  return 0;
}

}  // namespace geoprior::paper
