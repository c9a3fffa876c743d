#include "solvers/grammar/rules/building_stack.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace geoprior::grammar {
namespace {

constexpr double kLevelSnap = 1e-11;  ///< m
constexpr double kStackSnap = 1e-5;   ///< m, rad

/// x, y of the centre, yaw, width, depth.
using PlanVector = Eigen::Matrix<double, 5, 1>;
using PlanMatrix = Eigen::Matrix<double, 5, 5>;
using SideMatrix = Eigen::Matrix<double, 2, 5>;

PlanVector plan_vector(const StoreyBox& box) {
  PlanVector p;
  p << box.bottom.x(), box.bottom.y(), box.yaw, box.width, box.depth;
  return p;
}

void set_plan(StoreyBox& box, const PlanVector& p) {
  box.bottom.head<2>() = p.head<2>();
  box.yaw = p(2);
  box.width = p(3);
  box.depth = p(4);
}

/// Middles of the four sides, and their derivatives.
struct StackSides {
  std::array<Eigen::Vector2d, 4> middle;
  std::array<SideMatrix, 4> slope;

  explicit StackSides(const PlanVector& p) {
    const Eigen::Vector2d e(std::cos(p(2)), std::sin(p(2))), n(-e.y(), e.x());
    const Eigen::Vector2d centre = p.head<2>();
    for (int side = 0; side < 4; ++side) {
      const double sign = side == 0 || side == 3 ? -0.5 : 0.5;
      const bool across = side % 2 == 0;  // the sides 0 and 2 lie across the depth
      const Eigen::Vector2d d = across ? n : e;
      const Eigen::Vector2d turned(-d.y(), d.x());
      const int size = across ? 4 : 3;
      middle[side] = centre + sign * p(size) * d;
      slope[side].setZero();
      slope[side].leftCols<2>().setIdentity();
      slope[side].col(2) = sign * p(size) * turned;
      slope[side].col(size) = sign * d;
    }
  }
};

double stack_overhang(const PlanVector& below, const PlanVector& above) {
  const StackSides a(below), b(above);
  double most = 0;
  for (int side = 0; side < 4; ++side)
    most = std::max(most, (b.middle[side] - a.middle[side]).norm());
  return most;
}

bool stack_fits(const PlanVector& below, const PlanVector& above, double tolerance) {
  return stack_overhang(below, above) <= kMostOverhang + tolerance;
}

/// Value of a fit; gradient and the Gauss-Newton matrix, unless null.
double plan_fit(const PlanFit& f, const PlanVector& p, PlanVector* gradient, PlanMatrix* hessian) {
  const Eigen::Vector2d c = p.head<2>(), e(std::cos(p(2)), std::sin(p(2))), n(-e.y(), e.x());
  const double w = p(3), d = p(4);
  const Eigen::Vector2d fa = f.sa * c - f.ta, fb = f.sb * c - f.tb;
  const Eigen::Vector2d shift = f.sa * w * e + f.sb * d * n;
  if (gradient != nullptr) {
    gradient->head<2>() = 2 * (f.s * c + shift - f.t);
    (*gradient)(2) = 2 * (w * n.dot(fa) - d * e.dot(fb));
    (*gradient)(3) = 2 * (e.dot(fa) + f.saa * w);
    (*gradient)(4) = 2 * (n.dot(fb) + f.sbb * d);
  }
  if (hessian != nullptr) {
    hessian->setZero();
    hessian->topLeftCorner<2, 2>() = 2 * f.s * Eigen::Matrix2d::Identity();
    hessian->block<2, 1>(0, 2) = 2 * (f.sa * w * n - f.sb * d * e);
    hessian->block<2, 1>(0, 3) = 2 * f.sa * e;
    hessian->block<2, 1>(0, 4) = 2 * f.sb * n;
    (*hessian)(2, 2) = 2 * (f.saa * w * w + f.sbb * d * d);
    (*hessian)(2, 3) = -2 * f.sab * d;
    (*hessian)(2, 4) = 2 * f.sab * w;
    (*hessian)(3, 3) = 2 * f.saa;
    (*hessian)(4, 4) = 2 * f.sbb;
    hessian->triangularView<Eigen::StrictlyLower>() = hessian->transpose();
  }
  return f.s * c.squaredNorm() + 2 * c.dot(shift - f.t) + f.saa * w * w + f.sbb * d * d -
         2 * w * e.dot(f.ta) - 2 * d * n.dot(f.tb) + f.tt;
}

using HeldNumbers = std::array<bool, 5>;

void hold_numbers(const HeldNumbers& held, PlanVector& gradient, PlanMatrix& hessian) {
  for (int k = 0; k < 5; ++k) {
    if (!held[k]) continue;
    gradient(k) = 0;
    hessian.row(k).setZero();
    hessian.col(k).setZero();
    hessian(k, k) = 1;
  }
}

HeldNumbers held_numbers(const StoreyWish& wish) {
  const bool all = wish.hold_place || wish.given;
  const bool size = all || wish.hold_size;
  return {all, all, all, size, size};
}

/// Gauss-Newton with Levenberg's damping from `p`.
void descend_plan(const PlanFit& fit, const HeldNumbers& held, PlanVector& p) {
  double damping = 0, value = plan_fit(fit, p, nullptr, nullptr);
  for (int step = 0; step < 60; ++step) {
    PlanVector gradient;
    PlanMatrix hessian;
    plan_fit(fit, p, &gradient, &hessian);
    hold_numbers(held, gradient, hessian);
    hessian.diagonal() *= 1 + damping;
    const PlanVector move = -hessian.llt().solve(gradient);
    const double then = plan_fit(fit, p + move, nullptr, nullptr);
    if (then <= value) {
      p += move;
      value = then;
      damping = damping < 1e-6 ? 0 : damping / 10;
    } else {
      damping = std::max(1e-3, 10 * damping);
    }
    if (move.cwiseAbs().maxCoeff() < 1e-12 || damping > 1e9) return;
  }
}

/// The best fit of a storey that has no neighbours.
PlanVector lone_plan(const StoreyWish& wish) {
  PlanVector p = plan_vector(wish.given ? wish.goal : wish.rest);
  if (!wish.moved || wish.hold_place || wish.given) return p;
  // The rotation that takes the box nearest to the targets, from the centred moments.
  const PlanFit& f = wish.plan;
  const Eigen::Vector2d ta = f.ta - f.sa / f.s * f.t, tb = f.tb - f.sb / f.s * f.t;
  p(2) = std::atan2(p(3) * ta.y() - p(4) * tb.x(), p(3) * ta.x() + p(4) * tb.y());
  HeldNumbers held = held_numbers(wish);
  descend_plan(f, held, p);
  const double least[] = {wish.least_width, wish.least_depth};
  for (int k = 3; k < 5; ++k) {
    if (held[k] || p(k) >= least[k - 3]) continue;
    p(k) = least[k - 3];
    held[k] = true;
    descend_plan(f, held, p);
    k = 2;  // the other side may have become too short by this
  }
  return p;
}

/// The barrier function of a stack and Newton's method on it.
class StackBarrier {
 public:
  StackBarrier(std::span<const StoreyWish> wishes, double reach)
      : wishes_(wishes), reach2_(reach * reach), n_(static_cast<int>(wishes.size())) {
    for (const StoreyWish& wish : wishes) held_.push_back(held_numbers(wish));
  }

  [[nodiscard]] double value(const std::vector<PlanVector>& p, double mu) const;
  void minimise(std::vector<PlanVector>& p, double mu, int steps);

 private:
  static constexpr double kSideSlack = 1e-6;  ///< m: a side may begin at its least length

  [[nodiscard]] double least(int i, int k) const {
    return (k == 3 ? wishes_[i].least_width : wishes_[i].least_depth) - kSideSlack;
  }
  void assemble(const std::vector<PlanVector>& p, double mu);
  void solve();

  std::span<const StoreyWish> wishes_;
  double reach2_;
  int n_;
  std::vector<HeldNumbers> held_;
  std::vector<PlanVector> gradient_, move_;
  std::vector<PlanMatrix> diagonal_, upper_;  ///< upper: between a storey and the next
};

double StackBarrier::value(const std::vector<PlanVector>& p, double mu) const {
  constexpr double kOutside = std::numeric_limits<double>::infinity();
  double sum = 0;
  for (int i = 0; i < n_; ++i) {
    sum += plan_fit(wishes_[i].plan, p[i], nullptr, nullptr);
    for (int k = 3; k < 5; ++k) {
      if (held_[i][k]) continue;
      if (!(p[i](k) > least(i, k))) return kOutside;
      sum -= mu * std::log(p[i](k) - least(i, k));
    }
    if (i == 0) continue;
    const StackSides below(p[i - 1]), above(p[i]);
    for (int side = 0; side < 4; ++side) {
      const double room = reach2_ - (above.middle[side] - below.middle[side]).squaredNorm();
      if (!(room > 0)) return kOutside;
      sum -= mu * std::log(room);
    }
  }
  return sum;
}

void StackBarrier::assemble(const std::vector<PlanVector>& p, double mu) {
  gradient_.resize(n_);
  diagonal_.resize(n_);
  upper_.assign(n_, PlanMatrix::Zero());
  for (int i = 0; i < n_; ++i) {
    plan_fit(wishes_[i].plan, p[i], &gradient_[i], &diagonal_[i]);
    for (int k = 3; k < 5; ++k) {
      const double room = p[i](k) - least(i, k);
      if (held_[i][k]) continue;
      gradient_[i](k) -= mu / room;
      diagonal_[i](k, k) += mu / (room * room);
    }
  }
  for (int i = 0; i + 1 < n_; ++i) {
    const StackSides below(p[i]), above(p[i + 1]);
    for (int side = 0; side < 4; ++side) {
      const Eigen::Vector2d r = above.middle[side] - below.middle[side];
      const double q = reach2_ - r.squaredNorm();
      const Eigen::Vector2d g = 2 * mu / q * r;
      const Eigen::Matrix2d h =
          2 * mu / q * Eigen::Matrix2d::Identity() + 4 * mu / (q * q) * r * r.transpose();
      const SideMatrix &a = below.slope[side], &b = above.slope[side];
      gradient_[i] -= a.transpose() * g;
      gradient_[i + 1] += b.transpose() * g;
      diagonal_[i] += a.transpose() * h * a;
      diagonal_[i + 1] += b.transpose() * h * b;
      upper_[i] -= a.transpose() * h * b;
    }
  }
  for (int i = 0; i < n_; ++i) {
    hold_numbers(held_[i], gradient_[i], diagonal_[i]);
    for (int k = 0; k < 5; ++k) {
      if (held_[i][k]) upper_[i].row(k).setZero();
      if (i + 1 < n_ && held_[i + 1][k]) upper_[i].col(k).setZero();
    }
  }
}

/// Block elimination from the ground up.
void StackBarrier::solve() {
  move_.resize(n_);
  std::vector<Eigen::LLT<PlanMatrix>> factor(n_);
  for (int i = 0; i < n_; ++i) {
    PlanMatrix d = diagonal_[i];
    // What no sample and no neighbour decides stays.
    d.diagonal().array() += 1e-9;
    move_[i] = -gradient_[i];
    if (i > 0) {
      d -= upper_[i - 1].transpose() * factor[i - 1].solve(upper_[i - 1]);
      move_[i] -= upper_[i - 1].transpose() * factor[i - 1].solve(move_[i - 1]);
    }
    factor[i].compute(d);
  }
  for (int i = n_ - 1; i >= 0; --i) {
    if (i + 1 < n_) move_[i] -= upper_[i] * move_[i + 1];
    move_[i] = factor[i].solve(move_[i]);
  }
}

void StackBarrier::minimise(std::vector<PlanVector>& p, double mu, int steps) {
  std::vector<PlanVector> then(n_);
  double before = value(p, mu);
  for (int step = 0; step < steps; ++step) {
    assemble(p, mu);
    solve();
    double slope = 0, length = 1;
    for (int i = 0; i < n_; ++i) slope += gradient_[i].dot(move_[i]);
    if (!(slope < -0.01 * mu)) return;
    for (; length > 1e-8; length /= 2) {
      for (int i = 0; i < n_; ++i) then[i] = p[i] + length * move_[i];
      if (const double v = value(then, mu); v <= before + 0.1 * length * slope) {
        before = v;
        break;
      }
    }
    if (length <= 1e-8) return;
    p = then;
  }
}

/// Storeys above one another, sizes as at rest, or half way to that of the anchor.
std::vector<PlanVector> stack_start(std::span<const StoreyWish> wishes,
                                    const std::vector<PlanVector>& lone, int anchor, double blend) {
  const PlanVector rest = plan_vector(wishes[anchor].rest);
  const PlanVector at = lone[anchor];
  std::vector<PlanVector> p;
  for (std::size_t i = 0; i < wishes.size(); ++i) {
    const HeldNumbers held = held_numbers(wishes[i]);
    PlanVector own = plan_vector(wishes[i].rest);
    const PlanVector other = own - blend * (own - rest);
    own.head<2>() = at.head<2>();
    own(2) = at(2) + other(2) - rest(2);
    const double least[] = {wishes[i].least_width, wishes[i].least_depth};
    for (int k = 3; k < 5; ++k) {
      const double size = wishes[anchor].given ? other(k) + at(k) - rest(k) : other(k);
      if (!held[k]) own(k) = std::max(size, least[k - 3]);
    }
    p.push_back(wishes[i].hold_place || wishes[i].given ? lone[i] : own);
  }
  return p;
}

/// From the anchor on, moves a storey towards the one before it until it fits.
bool settle_stack(std::span<const StoreyWish> wishes, int from, int to, PlanVector& p,
                  const PlanVector& beside) {
  const auto fits = [&](const PlanVector& q) {
    return to > from ? stack_fits(beside, q, 1e-12) : stack_fits(q, beside, 1e-12);
  };
  const StoreyWish& wish = wishes[to];
  for (int k = 3; k < 5; ++k)
    if (!held_numbers(wish)[k]) p(k) = std::max(p(k), k == 3 ? wish.least_width : wish.least_depth);
  if (fits(p)) return true;
  PlanVector near = beside;
  near(2) = p(2) - std::remainder(p(2) - beside(2), 2 * std::numbers::pi);
  near(3) = std::max(near(3), wish.least_width);
  near(4) = std::max(near(4), wish.least_depth);
  const HeldNumbers held = held_numbers(wish);
  for (int k = 0; k < 5; ++k)
    if (held[k]) near(k) = p(k);
  if (!fits(near)) return false;
  double low = 0, high = 1;
  while (high - low > 1e-13) {
    const double middle = (low + high) / 2;
    (fits(near + middle * (p - near)) ? low : high) = middle;
  }
  p = near + low * (p - near);
  return true;
}

/// The storey from which the others take their place.
int stack_anchor(std::span<const StoreyWish> wishes) {
  for (std::size_t i = 0; i < wishes.size(); ++i)
    if (wishes[i].given) return static_cast<int>(i);
  for (std::size_t i = 0; i < wishes.size(); ++i)
    if (wishes[i].hold_place) return static_cast<int>(i);
  return 0;
}

bool stack_is_open(const std::vector<PlanVector>& p, double reach) {
  for (std::size_t i = 1; i < p.size(); ++i)
    if (stack_overhang(p[i - 1], p[i]) >= reach) return false;
  return true;
}

/// A start within the limits: as roomy a one as there is, then at rest.
bool open_start(std::span<const StoreyWish> wishes, const std::vector<PlanVector>& lone, int anchor,
                std::vector<PlanVector>& p, double& reach) {
  reach = kMostOverhang;
  for (const double blend : {0.5, 0.0}) {
    p = stack_start(wishes, lone, anchor, blend);
    if (stack_is_open(p, 0.99 * kMostOverhang)) return true;
  }
  reach += 1e-7;
  if (stack_is_open(p, reach)) return true;
  for (std::size_t i = 0; i < wishes.size(); ++i)
    p[i] = wishes[i].given ? lone[i] : plan_vector(wishes[i].rest);
  return stack_is_open(p, reach);
}

/// Minimum of x.a x / 2 - b.x within bounds, from a start within them, by an active set.
struct BoundedQuadratic {
  Eigen::MatrixXd a;
  Eigen::VectorXd b, x, low, high;
  std::vector<char> bound;

  explicit BoundedQuadratic(int n)
      : a(Eigen::MatrixXd::Zero(n, n)), b(Eigen::VectorXd::Zero(n)), x(n), low(n), high(n) {}

  void solve() {
    const int n = static_cast<int>(x.size());
    bound.resize(n);
    for (int i = 0; i < n; ++i) bound[i] = x(i) <= low(i) || x(i) >= high(i);
    for (int step = 0; step < 20 * n + 20; ++step)
      if (!advance() && !release()) return;
  }
  /// Towards the minimum of what is not at a bound: true, when something came to one.
  bool advance() {
    std::vector<int> open;
    for (int i = 0; i < x.size(); ++i)
      if (!bound[i]) open.push_back(i);
    if (open.empty()) return false;
    const Eigen::VectorXd pull = b - a * x;
    const Eigen::VectorXd move = a(open, open).llt().solve(Eigen::VectorXd(pull(open)));
    double length = 1;
    int stop = -1;
    for (int k = 0; k < std::ssize(open); ++k) {
      const double room = (move(k) > 0 ? high : low)(open[k]) - x(open[k]);
      if (std::abs(move(k)) <= 1e-13 || room / move(k) >= length) continue;
      length = std::max(0., room / move(k));
      stop = k;
    }
    for (int k = 0; k < std::ssize(open); ++k) x(open[k]) += length * move(k);
    if (stop < 0) return false;
    x(open[stop]) = (move(stop) > 0 ? high : low)(open[stop]);
    bound[open[stop]] = true;
    return true;
  }
  /// Lets go what the gradient pulls inwards most: false, where nothing is.
  bool release() {
    const Eigen::VectorXd pull = b - a * x;
    double most = 1e-9;
    int best = -1;
    for (int i = 0; i < x.size(); ++i) {
      const double inwards = x(i) <= low(i) ? pull(i) : -pull(i);
      if (!bound[i] || low(i) == high(i) || inwards <= most) continue;
      most = inwards;
      best = i;
    }
    if (best >= 0) bound[best] = false;
    return best >= 0;
  }
};

}  // namespace

double overhang(const StoreyBox& below, const StoreyBox& above) {
  return stack_overhang(plan_vector(below), plan_vector(above));
}

void PlanFit::add(double a, double b, double weight, const Eigen::Vector2d& target) {
  s += weight;
  sa += weight * a;
  sb += weight * b;
  saa += weight * a * a;
  sab += weight * a * b;
  sbb += weight * b * b;
  t += weight * target;
  ta += weight * a * target;
  tb += weight * b * target;
  tt += weight * target.squaredNorm();
}

void HeightFit::add(double c, double weight, double target) {
  s += weight;
  sc += weight * c;
  scc += weight * c * c;
  t += weight * target;
  tc += weight * c * target;
}

void wish_for(StoreyWish& wish, const StoreyBox& box, double weight) {
  const Eigen::Vector2d e(std::cos(box.yaw), std::sin(box.yaw)), n(-e.y(), e.x());
  for (const double a : {-0.5, 0.5})
    for (const double b : {-0.5, 0.5})
      wish.plan.add(a, b, weight / 4, box.bottom.head<2>() + a * box.width * e + b * box.depth * n);
  wish.rise.scc += weight;
  wish.rise.tc += weight * box.height;
}

bool fit_plans(std::span<const StoreyWish> wishes, std::vector<StoreyBox>& boxes) {
  const int n = static_cast<int>(wishes.size());
  std::vector<PlanVector> lone;
  for (const StoreyWish& wish : wishes) lone.push_back(lone_plan(wish));
  // A stack that was settled before fits, whatever round-off its yaws went through since.
  bool fits = true;
  for (int i = 1; i < n && fits; ++i) fits = stack_fits(lone[i - 1], lone[i], 1e-10);
  std::vector<PlanVector> p = lone;
  if (!fits) {
    const int anchor = stack_anchor(wishes);
    double reach = kMostOverhang;
    if (!open_start(wishes, lone, anchor, p, reach)) return false;
    StackBarrier barrier(wishes, reach);
    for (double mu = 1; mu > 1e-7; mu *= 0.1) barrier.minimise(p, mu, 40);
    for (int i = 0; i < n; ++i) {
      PlanVector difference = p[i] - lone[i];
      difference(2) = std::remainder(difference(2), 2 * std::numbers::pi);
      if (difference.cwiseAbs().maxCoeff() < kStackSnap) p[i] = lone[i];
    }
    for (int i = anchor + 1; i < n; ++i)
      if (!settle_stack(wishes, i - 1, i, p[i], p[i - 1])) return false;
    for (int i = anchor - 1; i >= 0; --i)
      if (!settle_stack(wishes, i + 1, i, p[i], p[i + 1])) return false;
  }
  for (int i = 0; i < n; ++i) set_plan(boxes[i], p[i]);
  return true;
}

std::vector<double> fit_levels(std::span<const StoreyWish> wishes) {
  // Unknown are the ground's level and the heights; a level is the sum of all before it.
  const int n = static_cast<int>(wishes.size()), m = n + 1;
  BoundedQuadratic q(m);
  q.low(0) = -std::numeric_limits<double>::infinity();
  q.high(0) = -q.low(0);
  q.x(0) = wishes[0].rest.bottom.z();
  for (int i = 0; i < n; ++i) {
    const StoreyWish& w = wishes[i];
    const bool held = w.hold_size || w.hold_place || w.given;
    const double own = w.given ? w.goal.height : w.rest.height;
    q.low(i + 1) = held ? own : w.least_height;
    q.high(i + 1) = held ? own : w.most_height;
    q.x(i + 1) = std::clamp(own, q.low(i + 1), q.high(i + 1));
    if (w.hold_place) q.low(0) = q.high(0) = q.x(0);
    q.a.topLeftCorner(i + 1, i + 1).array() += w.rise.s;
    q.a.col(i + 1).head(i + 1).array() += w.rise.sc;
    q.a.row(i + 1).head(i + 1).array() += w.rise.sc;
    q.a(i + 1, i + 1) += w.rise.scc;
    q.b.head(i + 1).array() += w.rise.t;
    q.b(i + 1) += w.rise.tc;
  }
  q.solve();
  // What comes out within round-off of its place stays there.
  std::vector<double> levels(m);
  levels[0] = q.x(0);
  for (int i = 0; i < n; ++i) {
    const StoreyBox& rest = wishes[i].rest;
    if (std::abs(levels[i] - rest.bottom.z()) < kLevelSnap) levels[i] = rest.bottom.z();
    const double own = rest.height, x = q.x(i + 1);
    const bool stays =
        std::abs(x - own) < kLevelSnap && own >= q.low(i + 1) && own <= q.high(i + 1);
    levels[i + 1] = levels[i] + (stays ? own : x);
  }
  return levels;
}

}  // namespace geoprior::grammar
