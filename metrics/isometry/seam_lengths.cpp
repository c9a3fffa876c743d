#include "metrics/isometry/seam_lengths.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"

namespace geoprior {
namespace {

void require_sewable(const Eigen::MatrixX2d& left, const Eigen::MatrixX2d& right) {
  if (left.rows() != right.rows() || left.rows() < 2) {
    throw Error(std::to_string(left.rows()) + " and " + std::to_string(right.rows()) + " points",
                "seam lengths", "equal numbers, two or more");
  }
  if (!left.allFinite() || !right.allFinite())
    throw Error("coordinate is not finite", "seam lengths", "finite numbers");
}

double segment_length(const Eigen::MatrixX2d& line, Eigen::Index i) {
  return (line.row(i + 1) - line.row(i)).norm();
}

}  // namespace

Eigen::VectorXd seam_shift(const Eigen::MatrixX2d& left, const Eigen::MatrixX2d& right) {
  require_sewable(left, right);
  Eigen::VectorXd shift(left.rows());
  shift(0) = 0;
  for (Eigen::Index i = 0; i + 1 < left.rows(); ++i)
    shift(i + 1) = shift(i) + segment_length(left, i) - segment_length(right, i);
  return shift;
}

SeamMismatch seam_mismatch(const Eigen::MatrixX2d& left, const Eigen::MatrixX2d& right) {
  SeamMismatch m;
  m.shift_max = seam_shift(left, right).cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i + 1 < left.rows(); ++i) {
    const double l = segment_length(left, i), r = segment_length(right, i);
    m.left_length += l;
    m.right_length += r;
    if (l + r > 0) m.segment_max = std::max(m.segment_max, 2 * std::abs(l - r) / (l + r));
  }
  const double both = m.left_length + m.right_length;
  if (!(both > 0)) throw Error("no length", "seam lengths", "an edge of positive length");
  m.relative = 2 * std::abs(m.left_length - m.right_length) / both;
  return m;
}

}  // namespace geoprior
