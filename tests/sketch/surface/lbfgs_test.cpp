#include "baselines/sketch/shared/lbfgs.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "core/random.h"

namespace geoprior::sketch {
namespace {

const Preconditioner kNoPreconditioner = [](Eigen::MatrixX3d&) {};

Eigen::MatrixX3d random_rows(Eigen::Index n, RandomStream& random) {
  Eigen::MatrixX3d x(n, 3);
  for (Eigen::Index i = 0; i < x.size(); ++i) x(i) = random.normal();
  return x;
}

/// Symmetric positive definite over 3 n coordinates.
Eigen::MatrixXd random_hessian(Eigen::Index size, RandomStream& random) {
  Eigen::MatrixXd half(size, size);
  for (Eigen::Index i = 0; i < half.size(); ++i) half(i) = random.normal();
  return half * half.transpose() + 0.1 * Eigen::MatrixXd::Identity(size, size);
}

Eigen::MatrixX3d product(const Eigen::MatrixXd& hessian, const Eigen::MatrixX3d& x) {
  const Eigen::VectorXd y = hessian * x.reshaped();
  return y.reshaped(x.rows(), 3);
}

TEST(Lbfgs, AnswersWhatTheLastStepTold) {
  // The secant condition: H^-1 maps the last change of the gradient to the last step.
  RandomStream random(8, "secant");
  const Eigen::MatrixXd hessian = random_hessian(15, random);
  Lbfgs lbfgs(3);
  for (int i = 0; i < 7; ++i) {
    const Eigen::MatrixX3d step = random_rows(5, random), change = product(hessian, step);
    lbfgs.add(step, change, kNoPreconditioner);
    EXPECT_LT((lbfgs.direction(-change, kNoPreconditioner) - step).norm(), 1e-10 * step.norm());
  }
}

TEST(Lbfgs, FindsTheMinimumOfAQuadraticInAsManyStepsAsItHasCoordinates) {
  // With exact line searches and full memory the steps are conjugate gradients.
  RandomStream random(9, "quadratic");
  for (const bool preconditioned : {false, true}) {
    const Eigen::MatrixXd hessian = random_hessian(12, random);
    const Eigen::MatrixXd inverse_diagonal = hessian.diagonal().cwiseInverse().asDiagonal();
    const Preconditioner metric = [&](Eigen::MatrixX3d& values) {
      if (preconditioned) values = product(inverse_diagonal, values);
    };
    Lbfgs lbfgs(12);
    Eigen::MatrixX3d x = random_rows(4, random);
    const double start = product(hessian, x).norm();
    for (int i = 0; i < 12; ++i) {
      const Eigen::MatrixX3d gradient = product(hessian, x);
      Eigen::MatrixX3d step = lbfgs.direction(gradient, metric);
      step *= -step.cwiseProduct(gradient).sum() / step.cwiseProduct(product(hessian, step)).sum();
      lbfgs.add(step, product(hessian, step), metric);
      x += step;
    }
    EXPECT_LT(product(hessian, x).norm(), 1e-8 * start);
  }
}

TEST(Lbfgs, LeavesOutStepsAlongWhichTheSlopeFell) {
  RandomStream random(10, "concave");
  const Eigen::MatrixX3d step = random_rows(4, random), gradient = random_rows(4, random);
  Lbfgs lbfgs(5);
  lbfgs.add(step, -step, kNoPreconditioner);
  EXPECT_EQ(lbfgs.direction(gradient, kNoPreconditioner), -gradient);
  lbfgs.add(step, 2 * step, kNoPreconditioner);
  EXPECT_LT((lbfgs.direction(gradient, kNoPreconditioner) + gradient / 2).norm(), 1e-14);
  lbfgs.forget();
  EXPECT_EQ(lbfgs.direction(gradient, kNoPreconditioner), -gradient);
}

}  // namespace
}  // namespace geoprior::sketch
