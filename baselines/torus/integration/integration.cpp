#include "baselines/torus/integration/integration.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "baselines/torus/integration/integral_curves.h"
#include "baselines/torus/integration/periodic_spline.h"
#include "baselines/torus/integration/spline_surface.h"
#include "core/limits.h"
#include "core/parallel.h"
#include "models/torus/frames.h"
#include "models/torus/revolution.h"
#include "models/torus/sampling.h"

namespace geoprior::torus {
namespace {

constexpr std::size_t kCurvesOfBlock = 8;
/// Two splines, the curves of a corrugation, the surfaces before and after it; as measured.
constexpr double kBytesPerNode = 190;

/// J_0(a) = q for q in (0, 1], by Newton's method in a^2.
double loop_amplitude(double q) {
  double x = (1 - q) * (1 + 0.25 * (1 - q) + 0.1958 * (1 - q) * (1 - q));
  for (int step = 0; step < 3; ++step) {
    const double a = 2 * std::sqrt(x);
    if (a < 1e-8) break;
    x += (std::cyl_bessel_j(0, a) - q) * a / (2 * std::cyl_bessel_j(1, a));
  }
  return 2 * std::sqrt(std::max(0., x));
}

/// Where a coefficient is not positive.
struct BadPlace {
  Eigen::Vector2d at;
  double rho = 0;
};

/// One corrugation of a grid surface.
class Integration {
 public:
  Integration(const TorusInput& input, int number, const SplineSurface& from,
              const SplineSurface& base, int n)
      : input_(input),
        number_(number),
        corrugation_(input.corrugations[number]),
        d_(kDirections[corrugation_.direction]),
        from_(from),
        base_(base),
        n_(n) {}

  GridSurface run() {
    std::vector<Eigen::MatrixX3d> curves(n_);  // glued points at the steps of each
    Eigen::MatrixXd places(n_, n_ + 1);        // a of curve s at step k
    std::vector<std::optional<BadPlace>> bad(n_);
    parallel_blocks(n_, kCurvesOfBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) {
        const IntegralCurve curve = integral_curve(from_, d_, static_cast<double>(s) / n_, n_);
        places.row(s) = curve.a.transpose();
        curves[s] = integrate(curve, bad[s]);
      }
    });
    for (const auto& place : bad)
      if (place) refuse_coefficient(input_, number_, place->rho, place->at);
    return resample(places, curves);
  }

 private:
  /// The corrugated points along a curve, glued.
  Eigen::MatrixX3d integrate(const IntegralCurve& curve, std::optional<BadPlace>& bad) const {
    // Gauss's points and weights of [0, 1].
    constexpr std::array<double, 4> kAt{0.069431844202973712, 0.33000947820757187,
                                        0.66999052179242813, 0.93056815579702629};
    constexpr std::array<double, 4> kWeight{0.17392742256872693, 0.32607257743127307,
                                            0.32607257743127307, 0.17392742256872693};
    Eigen::MatrixX3d F(n_ + 1, 3);
    F.row(0) = from_.at(curve.a(0) * d_.along).value;
    for (int k = 0; k < n_; ++k) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int g = 0; g < 4; ++g) {
        const double t = (k + kAt[g]) / n_;
        sum += kWeight[g] * loop(hermite(curve, k, kAt[g]), t, bad);
      }
      F.row(k + 1) = F.row(k) + sum.transpose() / n_;
    }
    const Eigen::RowVector3d gap =
        from_.at(curve.a(n_) * d_.along + d_.across).value.transpose() - F.row(n_);
    for (int k = 0; k <= n_; ++k) {
      const double t = static_cast<double>(k) / n_;
      F.row(k) += t * t * t * (6 * t * t - 15 * t + 10) * gap;
    }
    return F;
  }

  /// a between two steps, from the values and slopes at both.
  [[nodiscard]] double hermite(const IntegralCurve& curve, int k, double u) const {
    const double v = 1 - u;
    return curve.a(k) * v * v * (1 + 2 * u) + curve.a(k + 1) * u * u * (1 + 2 * v) +
           (curve.slope(k) * u * v * v - curve.slope(k + 1) * u * u * v) / n_;
  }

  /// r (cos(a cos 2 pi N t) t + sin(a cos 2 pi N t) n).
  Eigen::Vector3d loop(double a, double t, std::optional<BadPlace>& bad) const {
    const Eigen::Vector2d place = a * d_.along + t * d_.across;
    const SplineSurface::Point f = from_.at(place);
    const SplineSurface::Point b = base_.at(place);
    const double share = corrugation_.share;
    const double rho =
        coefficient(corrugation_.direction,
                    share + (1 - share) * b.along_x.squaredNorm() - f.along_x.squaredNorm(),
                    (1 - share) * b.along_x.dot(b.along_y) - f.along_x.dot(f.along_y),
                    share + (1 - share) * b.along_y.squaredNorm() - f.along_y.squaredNorm());
    if (!(rho > 0) && !bad) bad = BadPlace{place.array() - place.array().floor(), rho};
    const Eigen::Vector3d U = d_.across.x() * f.along_x + d_.across.y() * f.along_y;
    const Eigen::Vector3d V = d_.along.x() * f.along_x + d_.along.y() * f.along_y;
    const Eigen::Vector3d W = U - U.dot(V) / V.squaredNorm() * V;
    const double w = W.norm(), r = std::sqrt(w * w + std::max(0., rho) / d_.square());
    const double angle =
        loop_amplitude(w / r) * std::cos(2 * std::numbers::pi * corrugation_.number * t);
    return r * (std::cos(angle) / w * W + std::sin(angle) / (w * V.norm()) * V.cross(W));
  }

  /// The points of the grid: those with pi(x) = k / n lie 1 / n apart along V.
  GridSurface resample(const Eigen::MatrixXd& places,
                       const std::vector<Eigen::MatrixX3d>& curves) const {
    GridSurface out{n_, {}};
    for (Eigen::ArrayXXd& x : out.x) x.resize(n_, n_);
    // i = pi_x (k - pi_y j) modulo n (pi_x is -1), a = (i V_x + j V_y) / |V|^2 n.
    const auto pi_y = static_cast<std::int64_t>(d_.covector.y());
    parallel_blocks(n_, kCurvesOfBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        Eigen::VectorXd at(n_);
        for (int j = 0; j < n_; ++j) {
          const std::int64_t i = pi_y * j - static_cast<std::int64_t>(k);
          at(j) = (static_cast<double>(i) * d_.along.x() + j * d_.along.y()) / (d_.square() * n_);
        }
        Eigen::MatrixX3d values(n_, 3);
        for (int s = 0; s < n_; ++s) values.row(s) = curves[s].row(k);
        const Eigen::MatrixX3d points = periodic_spline(places.col(k), values, at);
        for (int j = 0; j < n_; ++j) {
          std::int64_t i = (pi_y * j - static_cast<std::int64_t>(k)) % n_;
          if (i < 0) i += n_;
          for (int c = 0; c < 3; ++c) out.x[c](i, j) = points(j, c);
        }
      }
    });
    return out;
  }

  const TorusInput& input_;
  int number_;
  const Corrugation& corrugation_;
  const WaveDirection& d_;
  const SplineSurface& from_;
  const SplineSurface& base_;
  int n_;
};

GridSurface revolution_grid(const Radii& radii, int n) {
  GridSurface out{n, {}};
  for (Eigen::ArrayXXd& x : out.x) x.resize(n, n);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector3d point =
          revolution_point(radii, {static_cast<double>(i) / n, static_cast<double>(j) / n});
      for (int c = 0; c < 3; ++c) out.x[c](i, j) = point(c);
    }
  return out;
}

class IntegrationTorus final : public TorusMap {
 public:
  IntegrationTorus(const TorusInput& input, const IntegrationOptions& options)
      : input_(input), options_(options) {}

  [[nodiscard]] std::optional<int> grid() const override { return options_.points; }

  void plan(std::span<const TorusSamples> all, RunContext& context) override {
    const int n = options_.points;
    const double count = static_cast<double>(n) * n;
    require_memory(kBytesPerNode * count, count, "points of a grid", "options.points");
    int most = 0;
    for (const TorusSamples& samples : all) most = std::max(most, samples.corrugations);
    points_.resize(all.size());
    GridSurface surface = revolution_grid(input_.radii, n);
    std::unique_ptr<SplineSurface> base, now;
    for (int k = 0; k <= most; ++k) {
      for (std::size_t i = 0; i < all.size(); ++i)
        if (all[i].corrugations == k) points_[i] = nodes(surface, all[i].at);
      if (k == most || context.stop_requested()) return;
      const Corrugation& corrugation = input_.corrugations[k];
      now = std::make_unique<SplineSurface>(surface);
      if (corrugation.begins_stage) base = std::make_unique<SplineSurface>(surface);
      surface = Integration(input_, k, *now, *base, n).run();
      context.progress((k + 1.) / most);
    }
  }

  Eigen::MatrixX3d points(std::size_t i, const TorusSamples& /*samples*/,
                          RunContext& /*context*/) override {
    return std::move(points_[i]);
  }

 private:
  static Eigen::MatrixX3d nodes(const GridSurface& surface, const Eigen::MatrixX2d& at) {
    Eigen::MatrixX3d out(at.rows(), 3);
    for (Eigen::Index r = 0; r < at.rows(); ++r)
      for (int c = 0; c < 3; ++c)
        out(r, c) = surface.x[c](grid_node(at(r, 0), surface.n), grid_node(at(r, 1), surface.n));
    return out;
  }

  TorusInput input_;
  IntegrationOptions options_;
  std::vector<Eigen::MatrixX3d> points_;
};

}  // namespace

void describe(OptionVisitor& v, IntegrationOptions& options) {
  v.value("points", options.points,
          {.doc = "points n of the grid along each side of the square, and integral curves of each "
                  "corrugation",
           .min = 16,
           .max = 8000});
}

std::unique_ptr<Process> make_integration_torus(const TorusInput& input,
                                                const IntegrationOptions& options) {
  return make_torus_process(input, [options](const TorusInput& given, RunContext&) {
    return std::make_unique<IntegrationTorus>(given, options);
  });
}

}  // namespace geoprior::torus
