#include "metrics/forms/normal_bands.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <unsupported/Eigen/FFT>

#include "core/error.h"

namespace geoprior {

Eigen::MatrixX3d curve_normals(const Eigen::MatrixX3d& curve, const Eigen::MatrixX3d& left,
                               const Eigen::MatrixX3d& right) {
  const Eigen::Index n = curve.rows();
  if (n < 3 || left.rows() != n || right.rows() != n)
    throw Error("a curve of " + std::to_string(n) + " points beside " +
                    std::to_string(left.rows()) + " and " + std::to_string(right.rows()),
                "curve_normals", "three points or more, as many on both sides");
  Eigen::MatrixX3d normals(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector3d along = curve.row((i + 1) % n) - curve.row((i + n - 1) % n);
    const Eigen::Vector3d across = left.row(i) - right.row(i);
    const Eigen::Vector3d normal = along.cross(across);
    const double length = normal.norm();
    if (!(length > 0))
      throw Error("no normal at point " + std::to_string(i), "curve_normals", "a surface");
    normals.row(i) = normal / length;
  }
  return normals;
}

Eigen::VectorXd band_power(const Eigen::MatrixX3d& samples, std::span<const double> edges) {
  if (samples.rows() == 0) throw Error("no samples", "band_power");
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (edges.size() < 2 || !(edges[i] >= 0) || (i > 0 && !(edges[i] > edges[i - 1])))
      throw Error("edge " + std::to_string(i) + " is " + std::to_string(edges[i]), "band_power",
                  "two edges or more that increase");
  const Eigen::Index n = samples.rows();
  Eigen::VectorXd power = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(edges.size()) - 1);
  Eigen::FFT<double> transform;
  Eigen::VectorXd column(n);
  Eigen::VectorXcd modes(n);
  for (int c = 0; c < 3; ++c) {
    column = samples.col(c);
    transform.fwd(modes.data(), column.data(), n);
    for (Eigen::Index k = 0; k <= n / 2; ++k) {
      const double both = k == 0 || 2 * k == n ? 1 : 2;
      const auto band = std::lower_bound(edges.begin(), edges.end(), static_cast<double>(k));
      if (band == edges.begin() || band == edges.end()) continue;
      power(band - edges.begin() - 1) += both * std::norm(modes(k) / static_cast<double>(n));
    }
  }
  return power;
}

double log_slope(std::span<const double> x, std::span<const double> y) {
  if (x.size() < 2 || x.size() != y.size())
    throw Error(std::to_string(x.size()) + " and " + std::to_string(y.size()) + " numbers",
                "log_slope", "two or more, as many of both");
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] > 0) || !(y[i] > 0))
      throw Error("number " + std::to_string(i) + " is not positive", "log_slope");
    const double u = std::log(x[i]), v = std::log(y[i]);
    sx += u, sy += v, sxx += u * u, sxy += u * v;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace geoprior
