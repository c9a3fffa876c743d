#include "metrics/spacing/radial_spectrum.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"

namespace geoprior {
namespace {

/// Complex numbers, one a point.
struct Phasors {
  Eigen::ArrayXd re, im;

  /// exp(-2 pi i times cycles)
  explicit Phasors(const Eigen::ArrayXd& cycles)
      : re((2 * std::numbers::pi * cycles).cos()), im(-(2 * std::numbers::pi * cycles).sin()) {}
  void turn_by(const Phasors& step) {
    const Eigen::ArrayXd turned = re * step.re - im * step.im;
    im = re * step.im + im * step.re;
    re = turned;
  }
  [[nodiscard]] double squared_sum() const {
    const double x = re.sum(), y = im.sum();
    return x * x + y * y;
  }
};

/// Powers at frequencies (k / width, l / height), l from `first`.
struct Row {
  int first = 0;
  std::vector<double> power;
};

void require(const Eigen::MatrixX2d& points, const Eigen::Vector2d& low,
             const Eigen::Vector2d& high, double unit, const RadialSpectrumOptions& o) {
  if (!(unit > 0) || !(o.highest > 0) || o.bins < 1) {
    throw Error("unit " + std::to_string(unit) + ", highest frequency " +
                    std::to_string(o.highest) + ", " + std::to_string(o.bins) + " bins",
                "radial spectrum", "all positive");
  }
  if (!((high - low).minCoeff() > 0)) throw Error("the rectangle is empty", "radial spectrum");
  if (points.rows() == 0) throw Error("no points", "radial spectrum");
  for (Eigen::Index i = 0; i < points.rows(); ++i) {
    const Eigen::Vector2d x = points.row(i);
    if (!((x - low).minCoeff() >= 0) || !((high - x).minCoeff() >= 0)) {
      throw Error("it is outside the rectangle", "point " + std::to_string(i));
    }
  }
}

/// Sums over the frequencies of a bin.
struct Bin {
  int count = 0;
  double power = 0, squares = 0;
  std::complex<double> axis = 0;
};

std::vector<Bin> in_bins(const std::vector<Row>& rows, const Eigen::Vector2d& size,
                         const RadialSpectrumOptions& options) {
  std::vector<Bin> bins(options.bins);
  const double width = options.highest / options.bins;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    for (std::size_t i = 0; i < rows[k].power.size(); ++i) {
      const std::complex<double> f(static_cast<double>(k) / size.x(),
                                   (rows[k].first + static_cast<double>(i)) / size.y());
      const auto b = static_cast<std::size_t>(std::abs(f) / width);
      if (b >= bins.size()) continue;
      const double power = rows[k].power[i];
      ++bins[b].count;
      bins[b].power += power;
      bins[b].squares += power * power;
      bins[b].axis += power * (f * f) / std::norm(f);
    }
  }
  return bins;
}

RadialSpectrum summary(const std::vector<Bin>& bins, double step) {
  RadialSpectrum s;
  const Eigen::Index n = bins.size();
  s.step = step;
  s.count.setZero(n);
  s.frequency.setZero(n);
  s.power.setZero(n);
  s.anisotropy.setZero(n);
  s.elongation.setZero(n);
  for (Eigen::Index b = 0; b < n; ++b) {
    const Bin& bin = bins[b];
    s.frequency(b) = step * (static_cast<double>(b) + 0.5);
    s.count(b) = bin.count;
    if (!(bin.power > 0)) continue;
    const double mean = bin.power / bin.count;
    s.power(b) = mean;
    s.anisotropy(b) = std::max(0., bin.squares / bin.count / (mean * mean) - 1);
    s.elongation(b) = std::abs(bin.axis) / bin.power;
  }
  return s;
}

}  // namespace

RadialSpectrum radial_spectrum(const Eigen::MatrixX2d& points, const Eigen::Vector2d& low,
                               const Eigen::Vector2d& high, double unit,
                               const RadialSpectrumOptions& options) {
  require(points, low, high, unit, options);
  const Eigen::Vector2d size = (high - low) / unit;
  const Eigen::ArrayXd x = (points.col(0).array() - low.x()) / (high - low).x();
  const Eigen::ArrayXd y = (points.col(1).array() - low.y()) / (high - low).y();
  const Phasors step(y);
  std::vector<Row> rows(static_cast<std::size_t>(options.highest * size.x()) + 1);
  parallel_blocks(rows.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const double across = static_cast<double>(k) / size.x();
      const double rest = options.highest * options.highest - across * across;
      const int last = static_cast<int>(std::sqrt(std::max(0., rest)) * size.y());
      rows[k].first = k == 0 ? 1 : -last;  // of f and -f, one
      Phasors phasors(static_cast<double>(k) * x + rows[k].first * y);
      for (int l = rows[k].first; l <= last; ++l, phasors.turn_by(step)) {
        rows[k].power.push_back(phasors.squared_sum() / static_cast<double>(points.rows()));
      }
    }
  });
  return summary(in_bins(rows, size, options), options.highest / options.bins);
}

double radial_spectrum_distance(const RadialSpectrum& a, const RadialSpectrum& b) {
  if (a.power.size() != b.power.size() || a.step != b.step) {
    throw Error(std::to_string(a.power.size()) + " and " + std::to_string(b.power.size()) +
                    " bins, widths " + std::to_string(a.step) + " and " + std::to_string(b.step),
                "distance of radial spectra", "the same");
  }
  return a.step * (a.power - b.power).cwiseAbs().sum();
}

double mean_elongation(const RadialSpectrum& spectrum, double highest) {
  const Eigen::VectorXd weight =
      (spectrum.frequency.array() < highest)
          .select(spectrum.count.cast<double>(), Eigen::VectorXd::Zero(spectrum.count.size()));
  if (!(weight.sum() > 0)) throw Error("no frequency is below", "mean_elongation");
  return spectrum.elongation.dot(weight) / weight.sum();
}

}  // namespace geoprior
