#include "models/sketch/drawing/ellipse_fit.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

#include "core/angles.h"
#include "core/error.h"
#include "core/numerics/jacobi_svd.h"
#include "models/sketch/drawing/curve_fit.h"

namespace geoprior::sketch {
namespace {

/// Share of the points' extent by which a line is told from an arc.
constexpr double kStraight = 1e-3;
constexpr double kSameEllipsePoint = 1e-9;  // of the points' extent

/// x = (p - shift) / scale, of mean 0 and root mean square 1.
struct PointFrame {
  Eigen::Vector2d shift{0, 0};
  double scale = 1;
  std::vector<Eigen::Vector2d> points;
};

PointFrame normalised(const std::vector<Eigen::Vector2d>& points) {
  PointFrame frame;
  for (const Eigen::Vector2d& p : points) frame.shift += p;
  frame.shift /= static_cast<double>(points.size());
  double sum = 0;
  for (const Eigen::Vector2d& p : points) sum += (p - frame.shift).squaredNorm();
  frame.scale = std::sqrt(sum / static_cast<double>(points.size()));
  for (const Eigen::Vector2d& p : points)
    frame.points.emplace_back((p - frame.shift) / (frame.scale > 0 ? frame.scale : 1));
  return frame;
}

int distinct_points(const PointFrame& frame) {
  int count = 0;
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    bool is_new = true;
    for (std::size_t j = 0; j < i && is_new && count < 5; ++j)
      is_new = (frame.points[i] - frame.points[j]).norm() > kSameEllipsePoint;
    count += is_new ? 1 : 0;
    if (count >= 5) break;
  }
  return count;
}

void require_arc(const PointFrame& frame, const std::string& where) {
  const int distinct = frame.scale > 0 ? distinct_points(frame) : 1;
  if (distinct < 5) {
    throw Error("an ellipse has five unknowns, and the arc " + std::to_string(distinct) +
                    " distinct points",
                where, "5 or more");
  }
  Eigen::Matrix2d moment = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : frame.points) moment += p * p.transpose();
  const Eigen::Vector2d size = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(moment).eigenvalues();
  if (!(std::sqrt(std::max(size(0), 0.0)) > kStraight * std::sqrt(size(1)))) {
    throw Error(
        "the arc is straight: its circle is seen edge on, and how it lies is not determined", where,
        "a view in which circles are seen as ellipses");
  }
}

/// a x^2 + b x y + c y^2 + d x + e y + f.
using Conic = Eigen::Matrix<double, 6, 1>;

double discriminant(const Conic& q) { return 4 * q(0) * q(2) - q(1) * q(1); }

Eigen::MatrixXd conic_rows(const std::vector<Eigen::Vector2d>& points) {
  Eigen::MatrixXd D(points.size(), 6);
  for (Eigen::Index i = 0; i < D.rows(); ++i) {
    const Eigen::Vector2d& p = points[i];
    D.row(i) << p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(), p.y(), 1;
  }
  return D;
}

/// Root mean square of the conic's value over its slope: about the distance (Sampson).
double sampson_rms(const Conic& q, const std::vector<Eigen::Vector2d>& points) {
  double sum = 0;
  for (const Eigen::Vector2d& p : points) {
    const double value = q(0) * p.x() * p.x() + q(1) * p.x() * p.y() + q(2) * p.y() * p.y() +
                         q(3) * p.x() + q(4) * p.y() + q(5);
    const Eigen::Vector2d slope(2 * q(0) * p.x() + q(1) * p.y() + q(3),
                                q(1) * p.x() + 2 * q(2) * p.y() + q(4));
    sum += value * value / std::max(slope.squaredNorm(), 1e-300);
  }
  return std::sqrt(sum / static_cast<double>(points.size()));
}

std::optional<Conic> ellipse_conic(const Eigen::MatrixXd& D) {
  const Eigen::MatrixXd D1 = D.leftCols(3), D2 = D.rightCols(3);
  const Eigen::Matrix3d S1 = D1.transpose() * D1, S2 = D1.transpose() * D2,
                        S3 = D2.transpose() * D2;
  const Eigen::Matrix3d T = -S3.fullPivLu().solve(S2.transpose());
  const Eigen::Matrix3d M = S1 + S2 * T;
  Eigen::Matrix3d reduced;
  reduced << M.row(2) / 2, -M.row(1), M.row(0) / 2;
  const Eigen::EigenSolver<Eigen::Matrix3d> eigen(reduced);
  std::optional<Conic> best;
  double most = 0;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d a = eigen.eigenvectors().col(k).real();
    const double d = (4 * a(0) * a(2) - a(1) * a(1)) / a.squaredNorm();
    if (!(d > most)) continue;
    most = d;
    Conic conic = Conic::Zero();
    conic.head<3>() = a;
    conic.tail<3>() = T * a;
    best = conic;
  }
  return best;
}

std::optional<Ellipse> ellipse_of(const Conic& q) {
  Eigen::Matrix2d A;
  A << q(0), q(1) / 2, q(1) / 2, q(2);
  const Eigen::Vector2d b(q(3), q(4));
  Ellipse e;
  e.centre = -0.5 * A.inverse() * b;
  const double level = -(q(5) + 0.5 * b.dot(e.centre));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(A / level);
  if (!(eigen.eigenvalues()(0) > 0) || !eigen.eigenvalues().allFinite()) return std::nullopt;
  e.major = 1 / std::sqrt(eigen.eigenvalues()(0));
  e.minor = 1 / std::sqrt(eigen.eigenvalues()(1));
  e.direction = eigen.eigenvectors().col(0);
  return e;
}

/// Centre, half axes along the direction and across it, and the angle of the direction.
void ellipse_curve(const Eigen::VectorXd& p, Eigen::Matrix<double, 2, 3>& columns,
                   Eigen::Matrix<double, 6, Eigen::Dynamic>& d) {
  const Eigen::Vector2d along(std::cos(p(4)), std::sin(p(4))), across(-along.y(), along.x());
  columns << p.head<2>(), p(2) * along, p(3) * across;
  d.setZero();
  d(0, 0) = d(1, 1) = 1;
  d.block<2, 1>(2, 2) = along;
  d.block<2, 1>(4, 3) = across;
  d.block<2, 1>(2, 4) = p(2) * across;
  d.block<2, 1>(4, 4) = -p(3) * along;
}

/// Difference of greatest and least s, each taken within half a turn of the one before.
double covered_span(const std::vector<double>& at) {
  double s = at.front(), low = s, high = s;
  for (const double next : at) {
    s += std::remainder(next - s, kFullTurn);
    low = std::min(low, s);
    high = std::max(high, s);
  }
  return std::min(high - low, kFullTurn);
}

}  // namespace

Eigen::Vector2d Ellipse::point(double s) const {
  const Eigen::Vector2d across(-direction.y(), direction.x());
  return centre + major * std::cos(s) * direction + minor * std::sin(s) * across;
}

double Ellipse::anomaly(const Eigen::Vector2d& x) const {
  const Eigen::Vector2d across(-direction.y(), direction.x());
  const Eigen::Vector2d d = x - centre;
  return std::atan2(d.dot(across) / minor, d.dot(direction) / major);
}

Ellipse direct_ellipse(const std::vector<Eigen::Vector2d>& points, const std::string& where) {
  const PointFrame frame = normalised(points);
  require_arc(frame, where);
  const Eigen::MatrixXd D = conic_rows(frame.points);
  const std::optional<Conic> conic = ellipse_conic(D);
  std::optional<Ellipse> ellipse = conic ? ellipse_of(*conic) : std::nullopt;
  const Conic free = Eigen::JacobiSVD<Eigen::MatrixXd>(D, Eigen::ComputeFullV).matrixV().col(5);
  // A hyperbola that hardly fits better is a flat ellipse drawn by an unsteady hand.
  constexpr double kClearlyBetter = 4;
  const bool hyperbola = discriminant(free) < 0 &&
                         (!ellipse || sampson_rms(*conic, frame.points) >
                                          kClearlyBetter * sampson_rms(free, frame.points) + 1e-9);
  if (hyperbola || !ellipse) {
    throw Error("the arc is a piece of a hyperbola, and no view of a circle", where,
                "a piece of an ellipse");
  }
  ellipse->centre = frame.shift + frame.scale * ellipse->centre;
  ellipse->major *= frame.scale;
  ellipse->minor *= frame.scale;
  return *ellipse;
}

EllipseFit fit_ellipse(const std::vector<Eigen::Vector2d>& points, const std::string& where) {
  const Ellipse start = direct_ellipse(points, where);
  const double scale = start.major;
  std::vector<Eigen::Vector2d> unit;
  std::vector<double> at;
  for (const Eigen::Vector2d& p : points) {
    unit.emplace_back((p - start.centre) / scale);
    at.push_back(start.anomaly(p));
  }
  Eigen::VectorXd parameters(5);
  parameters << 0, 0, 1, start.minor / scale, std::atan2(start.direction.y(), start.direction.x());
  const CurveFit fit = fit_curve(ellipse_curve, unit, parameters, at, {}, where);
  EllipseFit result;
  Ellipse& e = result.ellipse;
  e.centre = start.centre + scale * fit.parameters.head<2>();
  const double angle = fit.parameters(4);
  e.major = scale * std::abs(fit.parameters(2));
  e.minor = scale * std::abs(fit.parameters(3));
  e.direction = {std::cos(angle), std::sin(angle)};
  if (e.minor > e.major) {
    std::swap(e.major, e.minor);
    e.direction = Eigen::Vector2d(-e.direction.y(), e.direction.x());
  }
  result.rms = scale * fit.rms;
  result.max = scale * fit.max;
  result.condition = fit.condition;
  result.span = covered_span(fit.at);
  if (result.span < kLeastEllipseSpan) {
    std::array<char, 120> text{};
    std::snprintf(text.data(), text.size(), "%.0f degrees (condition %.0f)", result.span / kDegree,
                  result.condition);
    throw Error("its ellipse is not determined: the arc covers " + std::string(text.data()), where,
                "at least 45 degrees of the ellipse");
  }
  return result;
}

}  // namespace geoprior::sketch
