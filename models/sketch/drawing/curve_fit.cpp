#include "models/sketch/drawing/curve_fit.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/error.h"
#include "core/numerics/jacobi_svd.h"

namespace geoprior::sketch {
namespace {

/// p(s) - q for one point: blocks are the parameters of the curve, and s.
class PointOnCurve final : public ceres::CostFunction {
 public:
  PointOnCurve(const ConjugateCurve& curve, int parameters, const Eigen::Vector2d& point)
      : curve_(curve), parameters_(parameters), point_(point) {
    set_num_residuals(2);
    mutable_parameter_block_sizes()->push_back(parameters);
    mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Eigen::VectorXd parameters = Eigen::Map<const Eigen::VectorXd>(blocks[0], parameters_);
    Eigen::Matrix<double, 2, 3> columns;
    Eigen::Matrix<double, 6, Eigen::Dynamic> d(6, parameters_);
    curve_(parameters, columns, d);
    const double c = std::cos(blocks[1][0]), s = std::sin(blocks[1][0]);
    for (int k = 0; k < 2; ++k) {
      residuals[k] = columns(k, 0) + c * columns(k, 1) + s * columns(k, 2) - point_[k];
      if (jacobians == nullptr) continue;
      if (jacobians[0] != nullptr) {
        for (int i = 0; i < parameters_; ++i)
          jacobians[0][k * parameters_ + i] = d(k, i) + c * d(2 + k, i) + s * d(4 + k, i);
      }
      if (jacobians[1] != nullptr) jacobians[1][k] = c * columns(k, 2) - s * columns(k, 1);
    }
    return true;
  }

 private:
  const ConjugateCurve& curve_;
  int parameters_;
  Eigen::Vector2d point_;
};

/// Of the distances along the curve's normals by the parameters that are free.
double distance_condition(const ConjugateCurve& curve, const CurveFit& fit,
                          const std::vector<int>& fixed) {
  const Eigen::Index n = fit.at.size();
  const Eigen::Index m = fit.parameters.size();
  if (m == std::ssize(fixed)) return 1;
  Eigen::Matrix<double, 2, 3> columns;
  Eigen::Matrix<double, 6, Eigen::Dynamic> d(6, m);
  curve(fit.parameters, columns, d);
  Eigen::MatrixXd J(n, m - fixed.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    const double c = std::cos(fit.at[i]);
    const double s = std::sin(fit.at[i]);
    const Eigen::Vector2d along = (c * columns.col(2) - s * columns.col(1)).normalized();
    const Eigen::RowVector2d normal(-along.y(), along.x());
    Eigen::Index column = 0;
    for (Eigen::Index k = 0; k < m; ++k) {
      if (std::find(fixed.begin(), fixed.end(), static_cast<int>(k)) != fixed.end()) continue;
      J(i, column++) =
          normal * (d.block<2, 1>(0, k) + c * d.block<2, 1>(2, k) + s * d.block<2, 1>(4, k));
    }
  }
  const Eigen::VectorXd sigma = Eigen::JacobiSVD<Eigen::MatrixXd>(J).singularValues();
  const double least = sigma(sigma.size() - 1);
  return least > 0 ? sigma(0) / least : std::numeric_limits<double>::infinity();
}

ceres::Solver::Options curve_solver(std::vector<double>& at) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (double& s : at) options.linear_solver_ordering->AddElementToGroup(&s, 0);
  options.num_threads = 1;
  options.max_num_iterations = 200;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

CurveFit fit_curve(const ConjugateCurve& curve, const std::vector<Eigen::Vector2d>& points,
                   const Eigen::VectorXd& start, const std::vector<double>& at,
                   const std::vector<int>& fixed, const std::string& where) {
  CurveFit fit;
  fit.parameters = start;
  fit.at = at;
  const int m = static_cast<int>(start.size());
  ceres::Problem problem;
  for (std::size_t i = 0; i < points.size(); ++i) {
    problem.AddResidualBlock(new PointOnCurve(curve, m, points[i]), nullptr, fit.parameters.data(),
                             &fit.at[i]);
  }
  if (std::ssize(fixed) == m) {
    problem.SetParameterBlockConstant(fit.parameters.data());
  } else if (!fixed.empty()) {
    problem.SetManifold(fit.parameters.data(), new ceres::SubsetManifold(m, fixed));
  }
  ceres::Solver::Options options = curve_solver(fit.at);
  options.linear_solver_ordering->AddElementToGroup(fit.parameters.data(), 1);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable() || !fit.parameters.allFinite())
    throw Error("no curve could be fitted: " + summary.message, where, "points along one arc");

  Eigen::Matrix<double, 2, 3> columns;
  Eigen::Matrix<double, 6, Eigen::Dynamic> d(6, m);
  curve(fit.parameters, columns, d);
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d weight(1, std::cos(fit.at[i]), std::sin(fit.at[i]));
    const double squared = (columns * weight - points[i]).squaredNorm();
    sum += squared;
    fit.max = std::max(fit.max, std::sqrt(squared));
  }
  fit.rms = std::sqrt(sum / static_cast<double>(points.size()));
  fit.condition = distance_condition(curve, fit, fixed);
  return fit;
}

}  // namespace geoprior::sketch
