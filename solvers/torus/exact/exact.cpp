#include "solvers/torus/exact/exact.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "models/torus/directions.h"
#include "models/torus/frames.h"
#include "solvers/torus/jets/revolution_jet.h"

namespace geoprior::torus {
namespace {

/// Where a coefficient is not positive: the corrugation, and the row of the points.
struct BadCoefficient {
  int corrugation = -1;
  int lane = 0;
  double rho = 0;
};

/// The chain of corrugations at four points, from an order to the one that is wanted.
class JetChain {
 public:
  JetChain(const TorusInput& input, const Lane& x, const Lane& y) : input_(input), x_(x), y_(y) {}

  /// The surface with derivatives up to `Wanted`.
  template <int Wanted, int Order>
  JetVector<Wanted> run() {
    const JetVector<Order> f = revolution_jet<Order>(input_.radii, x_, y_);
    if constexpr (Order == Wanted) {
      return f;
    } else {
      return from<Wanted, Order>(0, f, nullptr);
    }
  }
  [[nodiscard]] const BadCoefficient& bad() const { return bad_; }

 private:
  /// @param before  metric that the stage began with; null where this one begins it
  template <int Wanted, int Order>
  JetVector<Wanted> from(int done, const JetVector<Order>& f, const JetMetric<Order - 1>* before) {
    const Corrugation& corrugation = input_.corrugations[done];
    JetVector<Order - 1> x, y;
    for (int k = 0; k < 3; ++k) {
      x[k] = derivative_x(f[k]);
      y[k] = derivative_y(f[k]);
    }
    const JetMetric<Order - 1> base = corrugation.begins_stage ? pulled_back(x, y) : *before;
    const auto made =
        corrugate(x, y, toward_square(base, corrugation.share), corrugation, periods(corrugation));
    note(done, made.rho.value());
    JetVector<Order - 1> next;
    for (int k = 0; k < 3; ++k) next[k] = cut<Order - 1>(f[k]) + made.shift[k];
    if constexpr (Order - 1 == Wanted) {
      return next;
    } else {
      const JetMetric<Order - 2> kept{cut<Order - 2>(base.E), cut<Order - 2>(base.F),
                                      cut<Order - 2>(base.G)};
      return from<Wanted, Order - 1>(done + 1, next, &kept);
    }
  }

  /// N pi(x) up to whole periods: each parameter's own are left out before they are large.
  [[nodiscard]] Lane periods(const Corrugation& corrugation) const {
    const Eigen::Vector2d pi = kDirections[corrugation.direction].covector;
    const Lane along_x = corrugation.number * x_, along_y = corrugation.number * y_;
    return pi.x() * (along_x - along_x.round()) + pi.y() * (along_y - along_y.round());
  }

  void note(int corrugation, const Lane& rho) {
    if (bad_.corrugation >= 0) return;
    for (int l = 0; l < 4; ++l)
      if (!(rho[l] > 0)) {
        bad_ = {corrugation, l, rho[l]};
        return;
      }
  }

  const TorusInput& input_;
  Lane x_, y_;
  BadCoefficient bad_;
};

template <int Wanted>
JetVector<Wanted> run_chain(JetChain& chain, int corrugations) {
  switch (corrugations) {
    case 0:
      return chain.run<Wanted, Wanted>();
    case 1:
      return chain.run<Wanted, Wanted + 1>();
    case 2:
      return chain.run<Wanted, Wanted + 2>();
    case 3:
      return chain.run<Wanted, Wanted + 3>();
    case 4:
      return chain.run<Wanted, Wanted + 4>();
    case 5:
      return chain.run<Wanted, Wanted + 5>();
    default:
      return chain.run<Wanted, Wanted + kMostCorrugations>();
  }
}

/// Coefficient `c` of the jets of four points into rows of a matrix.
template <int Order>
void store(const JetVector<Order>& f, int c, Eigen::Index row, Eigen::Index lanes,
           Eigen::MatrixX3d& into) {
  for (int k = 0; k < 3; ++k)
    for (Eigen::Index l = 0; l < lanes; ++l) into(row + l, k) = f[k].c[c][l];
}

class ExactTorus final : public TorusMap {
 public:
  explicit ExactTorus(const TorusInput& input) : input_(input) {}

  Eigen::MatrixX3d points(std::size_t /*i*/, const TorusSamples& samples,
                          RunContext& context) override {
    constexpr Eigen::Index kAtOnce = 1 << 18;  // between two looks at whether to stop
    const Eigen::Index n = samples.at.rows();
    Eigen::MatrixX3d out(n, 3);
    for (Eigen::Index first = 0; first < n && !context.stop_requested(); first += kAtOnce) {
      const Eigen::Index count = std::min(kAtOnce, n - first);
      out.middleRows(first, count) =
          exact_points(input_, samples.corrugations, samples.at.middleRows(first, count), false)
              .points;
    }
    return out;
  }

  void diagnose(const TorusSamples& places, std::map<std::string, double>& into) const override {
    const ExactPoints at = exact_points(input_, places.corrugations, places.at, true);
    double sum = 0;
    for (Eigen::Index i = 0; i < at.points.rows(); ++i) {
      const double E = 1 - at.along_x.row(i).squaredNorm(), G = 1 - at.along_y.row(i).squaredNorm();
      const double F = at.along_x.row(i).dot(at.along_y.row(i));
      sum += std::sqrt(E * E + 2 * F * F + G * G);
    }
    into["tangent_default"] = sum / static_cast<double>(at.points.rows());
  }

 private:
  TorusInput input_;
};

}  // namespace

void describe(OptionVisitor& /*v*/, ExactOptions& /*options*/) {}

ExactPoints exact_points(const TorusInput& input, int corrugations, const Eigen::MatrixX2d& at,
                         bool derivatives) {
  constexpr std::size_t kBlock = 64;  // of four points
  const Eigen::Index n = at.rows();
  ExactPoints out{Eigen::MatrixX3d(n, 3), {}, {}};
  if (derivatives) {
    out.along_x.resize(n, 3);
    out.along_y.resize(n, 3);
  }
  const std::size_t lanes = (n + 3) / 4;
  std::vector<BadCoefficient> bad(lanes);
  parallel_blocks(lanes, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const Eigen::Index row = 4 * b, count = std::min<Eigen::Index>(4, n - row);
      Lane x, y;
      for (Eigen::Index l = 0; l < 4; ++l) {
        x[l] = at(row + std::min(l, count - 1), 0);
        y[l] = at(row + std::min(l, count - 1), 1);
      }
      JetChain chain(input, x, y);
      if (derivatives) {
        const JetVector<1> f = run_chain<1>(chain, corrugations);
        store(f, monomial(0, 0), row, count, out.points);
        store(f, monomial(1, 0), row, count, out.along_x);
        store(f, monomial(1, 1), row, count, out.along_y);
      } else {
        store(run_chain<0>(chain, corrugations), monomial(0, 0), row, count, out.points);
      }
      bad[b] = chain.bad();
    }
  });
  for (std::size_t b = 0; b < lanes; ++b)
    if (bad[b].corrugation >= 0)
      refuse_coefficient(input, bad[b].corrugation, bad[b].rho, at.row(4 * b + bad[b].lane));
  return out;
}

std::unique_ptr<Process> make_exact_torus(const TorusInput& input, const ExactOptions&) {
  if (std::ssize(input.corrugations) > kMostCorrugations)
    throw Error("asks for " + std::to_string(input.corrugations.size()) +
                    " corrugations: the exact mode has jets for " +
                    std::to_string(kMostCorrugations),
                "scene.corrugations");
  return make_torus_process(input, [](const TorusInput& given, RunContext&) {
    return std::make_unique<ExactTorus>(given);
  });
}

}  // namespace geoprior::torus
