#include "solvers/torus/exact/numbers.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/random.h"
#include "models/torus/directions.h"
#include "solvers/torus/exact/exact.h"

namespace geoprior::torus {
namespace {

constexpr int kPlaces = 4096;
constexpr int kMostNumber = 1000000000;

Eigen::MatrixX2d places() {
  RandomStream random(1, "numbers of corrugations");
  Eigen::MatrixX2d at(kPlaces, 2);
  for (Eigen::Index i = 0; i < at.rows(); ++i) at.row(i) << random.uniform(), random.uniform();
  return at;
}

/// First fundamental form at every place: E, F, G.
using Forms = Eigen::MatrixX3d;

Forms forms_of(const ExactPoints& at) {
  Forms out(at.points.rows(), 3);
  for (Eigen::Index i = 0; i < out.rows(); ++i)
    out.row(i) << at.along_x.row(i).squaredNorm(), at.along_x.row(i).dot(at.along_y.row(i)),
        at.along_y.row(i).squaredNorm();
  return out;
}

Eigen::VectorXd coefficients(int direction, const Forms& forms) {
  Eigen::VectorXd out(forms.rows());
  for (Eigen::Index i = 0; i < out.size(); ++i)
    out(i) = coefficient(direction, forms(i, 0), forms(i, 1), forms(i, 2));
  return out;
}

/// (1 - share) base + share Id.
Forms target(const Forms& base, double share) {
  Forms out = (1 - share) * base;
  out.col(0).array() += share;
  out.col(2).array() += share;
  return out;
}

/// Whether a number leaves enough of what comes next.
class NextCoefficients {
 public:
  NextCoefficients(const TorusInput& input, int corrugation, double margin)
      : input_(input), number_(corrugation), margin_(margin), at_(places()) {
    before_ = forms_of(exact_points(input_, number_, at_, true));
    const int base = stage_base(input_, number_);
    base_ = base == number_ ? before_ : forms_of(exact_points(input_, base, at_, true));
    find_next();
  }

  bool enough(int number) {
    input_.corrugations[number_].number = number;
    const Forms after = forms_of(exact_points(input_, number_ + 1, at_, true));
    const Corrugation& c = input_.corrugations[number_];
    const Eigen::Vector2d pi = kDirections[c.direction].covector;
    const Eigen::VectorXd rho = coefficients(c.direction, target(base_, c.share) - before_) /
                                kDirections[c.direction].square();
    Forms ideal = before_;
    ideal.col(0) += pi.x() * pi.x() * rho;
    ideal.col(1) += pi.x() * pi.y() * rho;
    ideal.col(2) += pi.y() * pi.y() * rho;
    for (const int direction : next_) {
      const Eigen::VectorXd have = coefficients(direction, aim(after) - after);
      const Eigen::VectorXd would = coefficients(direction, aim(ideal) - ideal);
      if (!(have.array() >= margin_ * would.array()).all()) return false;
    }
    return true;
  }
  /// Whether anything comes after the corrugation.
  [[nodiscard]] bool matters() const { return !next_.empty(); }

 private:
  void find_next() {
    const auto& all = input_.corrugations;
    const int first = number_ + 1;
    new_stage_ = first < std::ssize(all) && all[first].begins_stage;
    if (new_stage_) share_ = all[first].share;
    for (int i = first; i < std::ssize(all) && (i == first || !all[i].begins_stage); ++i)
      next_.push_back(all[i].direction);
  }
  /// Where the next corrugation wants to go from a metric.
  [[nodiscard]] Forms aim(const Forms& from) const {
    return new_stage_ ? target(from, share_) : target(base_, input_.corrugations[number_].share);
  }

  TorusInput input_;
  int number_;
  double margin_;
  Eigen::MatrixX2d at_;
  Forms before_, base_;
  std::vector<int> next_;  ///< directions
  bool new_stage_ = false;
  double share_ = 1;
};

int choose(const TorusInput& input, int corrugation, int least, double margin) {
  NextCoefficients next(input, corrugation, margin);
  if (!next.matters()) return least;
  int high = least;
  while (!next.enough(high)) {
    if (high > kMostNumber / 2)
      throw Error("no number up to 10^9 leaves the next coefficients positive",
                  "scene.corrugations[" + std::to_string(corrugation) + "]");
    high *= 2;
  }
  int low = high / 2;  // fails, or is below the least
  while (high - low > std::max(1, high / 64)) {
    const int middle = low + (high - low) / 2;
    (next.enough(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

void choose_numbers(TorusInput& input, double margin) {
  int least = 2;
  for (int i = 0; i < std::ssize(input.corrugations); ++i) {
    int& number = input.corrugations[i].number;
    if (number == kChosenNumber) number = choose(input, i, least, margin);
    least = std::min(2 * number, kMostNumber);
  }
}

}  // namespace geoprior::torus
