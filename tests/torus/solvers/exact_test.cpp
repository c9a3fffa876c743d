#include "solvers/torus/exact/exact.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "models/torus/directions.h"
#include "models/torus/revolution.h"
#include "solvers/torus/exact/numbers.h"
#include "tests/torus/torus_inputs.h"

namespace geoprior::torus {
namespace {

struct Form {
  double E, F, G;
};

Form form_at(const ExactPoints& at, Eigen::Index i) {
  return {at.along_x.row(i).squaredNorm(), at.along_x.row(i).dot(at.along_y.row(i)),
          at.along_y.row(i).squaredNorm()};
}

double norm(double E, double F, double G) { return std::sqrt(E * E + 2 * F * F + G * G); }

double mean_default(const TorusInput& input, int corrugations, int places = 4000) {
  const ExactPoints at = exact_points(input, corrugations, drawn_places(places), true);
  double sum = 0;
  for (Eigen::Index i = 0; i < at.points.rows(); ++i) {
    const Form f = form_at(at, i);
    sum += norm(1 - f.E, f.F, 1 - f.G);
  }
  return sum / places;
}

/// Mean |f* + rho pi^2 / |pi|^2 - F*| of the last corrugation.
double mean_error(const TorusInput& input) {
  const int last = static_cast<int>(input.corrugations.size()) - 1;
  const Corrugation& c = input.corrugations[last];
  const Eigen::MatrixX2d places = drawn_places(4000);
  const ExactPoints base = exact_points(input, stage_base(input, last), places, true);
  const ExactPoints before = exact_points(input, last, places, true);
  const ExactPoints after = exact_points(input, last + 1, places, true);
  const Eigen::Vector2d pi = kDirections[c.direction].covector;
  double sum = 0;
  for (Eigen::Index i = 0; i < places.rows(); ++i) {
    const Form b = form_at(base, i), f = form_at(before, i), F = form_at(after, i);
    const double rho = coefficient(c.direction, c.share + (1 - c.share) * b.E - f.E,
                                   (1 - c.share) * b.F - f.F, c.share + (1 - c.share) * b.G - f.G) /
                       pi.squaredNorm();
    sum += norm(f.E + rho * pi.x() * pi.x() - F.E, f.F + rho * pi.x() * pi.y() - F.F,
                f.G + rho * pi.y() * pi.y() - F.G);
  }
  return sum / static_cast<double>(places.rows());
}

TEST(Exact, WithoutCorrugationsIsTheTorusOfRevolution) {
  const TorusInput input = published_input();
  const Eigen::MatrixX2d places = drawn_places(9);  // a lane is not full
  const ExactPoints at = exact_points(input, 0, places, true);
  for (Eigen::Index i = 0; i < places.rows(); ++i) {
    const Eigen::Vector2d x = places.row(i);
    EXPECT_LT((at.points.row(i).transpose() - revolution_point(input.radii, x)).norm(), 1e-15);
    EXPECT_NEAR(at.along_x.row(i).norm(), input.radii.tube, 1e-14) << "circles of radius r1 / 2 pi";
  }
}

TEST(Exact, CoefficientsOfTheTorusOfRevolutionAreThoseByHand) {
  // E = r1^2, F = 0, G = (r2 + r1 cos)^2 between .3^2 and .7^2: rho_0 = .96 - (1 - G) / 4,
  // rho_1 = rho_2 = 5/8 (1 - G).
  const TorusInput input = published_input();
  const ExactPoints at = exact_points(input, 0, drawn_places(20000), true);
  Eigen::Array3d least = Eigen::Array3d::Constant(9), most = -least;
  for (Eigen::Index i = 0; i < at.points.rows(); ++i) {
    const Form f = form_at(at, i);
    for (int k = 0; k < 3; ++k) {
      const double rho = coefficient(k, 1 - f.E, -f.F, 1 - f.G);
      least(k) = std::min(least(k), rho);
      most(k) = std::max(most(k), rho);
    }
  }
  EXPECT_NEAR(least(0), 0.7325, 1e-6);
  EXPECT_NEAR(most(0), 0.8325, 1e-6);
  for (const int k : {1, 2}) {
    EXPECT_NEAR(least(k), 0.31875, 1e-6);
    EXPECT_NEAR(most(k), 0.56875, 1e-6);
  }
}

TEST(Exact, DerivativesAreThoseOfItsPoints) {
  const TorusInput input = published_input();
  for (const int corrugations : {1, 2, 3}) {
    const double h = 1e-6 / std::pow(8, corrugations);
    const Eigen::MatrixX2d places = drawn_places(64);
    const ExactPoints at = exact_points(input, corrugations, places, true);
    for (int k = 0; k < 2; ++k) {
      Eigen::MatrixX2d ahead = places, behind = places;
      ahead.col(k).array() += h;
      behind.col(k).array() -= h;
      const Eigen::MatrixX3d difference =
          (exact_points(input, corrugations, ahead, false).points -
           exact_points(input, corrugations, behind, false).points) /
          (2 * h);
      const Eigen::MatrixX3d& along = k == 0 ? at.along_x : at.along_y;
      EXPECT_LT((difference - along).cwiseAbs().maxCoeff(), 2e-4) << corrugations << " " << k;
    }
  }
}

TEST(Exact, IsPeriodic) {
  const TorusInput input = published_input();
  const Eigen::MatrixX2d places = drawn_places(64);
  Eigen::MatrixX2d shifted = places;
  shifted.col(0).array() += 1;
  shifted.col(1).array() -= 2;
  EXPECT_LT(
      (exact_points(input, 3, places, false).points - exact_points(input, 3, shifted, false).points)
          .cwiseAbs()
          .maxCoeff(),
      1e-11);
}

// The figures are those of a grid of 8000 x 8000 points, and of the published program for the
// first.
TEST(Exact, DefaultsOfThePublishedNumbersAreKnown) {
  const TorusInput input = published_input();
  EXPECT_NEAR(mean_default(input, 0), 1.2114, 0.005);
  EXPECT_NEAR(mean_default(input, 1), 1.0511, 0.005);
  EXPECT_NEAR(mean_default(input, 2), 0.8353, 0.005);
  EXPECT_NEAR(mean_default(input, 3), 0.634, 0.01);
}

TEST(Exact, ErrorOfACorrugationHalvesWhereItsNumberDoubles) {
  for (int last = 0; last < 3; ++last) {
    TorusInput input = published_input();
    input.corrugations.resize(last + 1);
    int& number = input.corrugations[last].number;
    const double coarse = mean_error(input);
    number *= 2;
    const double fine = mean_error(input);
    EXPECT_NEAR(std::log2(coarse / fine), 1, 0.1) << last;
  }
}

TEST(Exact, FirstErrorIsThatOfTheLiterature) {
  TorusInput input = published_input();
  input.corrugations.resize(1);
  EXPECT_NEAR(mean_error(input), 0.0331, 0.001);
  input.corrugations[0].number = 6;
  EXPECT_NEAR(mean_error(input), 0.0662, 0.002);
}

TEST(Exact, IsTheSameAtAnyNumberOfThreads) {
  const TorusInput input = published_input();
  const Eigen::MatrixX2d places = drawn_places(5000);
  std::array<Eigen::MatrixX3d, 2> points;
  for (const int threads : {1, 2})
    with_threads(threads,
                 [&] { points[threads - 1] = exact_points(input, 3, places, false).points; });
  EXPECT_EQ(points[0], points[1]);
}

TEST(Exact, NamesWhereACoefficientIsNotPositive) {
  TorusInput input = published_input({12, 12, 12});
  input.corrugations.push_back({0, 24, 0.8, false});
  input.corrugations.push_back({1, 48, 0.95, true});
  try {
    exact_points(input, 5, drawn_places(4000), false);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::ContainsRegex(
                                  R"(scene\.corrugations\[[1-4]\]: the coefficient rho_[0-2] = .* )"
                                  R"(is not positive at x = 0\.[0-9]+, y = 0\.)"));
  }
}

TEST(ChosenNumbers, LeaveWhatComesNextPositiveAndAreNotLargerThanNeeded) {
  TorusInput input = published_input({kChosenNumber, kChosenNumber, kChosenNumber});
  input.corrugations.push_back({0, kChosenNumber, 0.8, false});
  choose_numbers(input, 0.5);
  int before = 0;
  for (const Corrugation& c : input.corrugations) {
    EXPECT_GT(c.number, before);
    before = c.number;
  }
  EXPECT_NO_THROW(exact_points(input, 4, drawn_places(4000, 2), false));
}

}  // namespace
}  // namespace geoprior::torus
