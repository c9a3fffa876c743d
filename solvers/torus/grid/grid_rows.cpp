#include "solvers/torus/grid/grid_rows.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "models/torus/revolution.h"
#include "solvers/torus/jets/corrugated_jet.h"

namespace geoprior::torus {
namespace {

Lane load(const double* x) { return Eigen::Map<const Lane>(x); }

/// Derivatives at four columns from i on, by differences of fourth order:
/// f' = (f(-2h) - 8 f(-h) + 8 f(h) - f(2h)) / 12h.
struct Differences {
  JetVector<0> x, y;
};

Differences differences(const GridRows& f, int n, int row, int i) {
  const double scale = n / 12.;
  Differences out;
  for (int c = 0; c < 3; ++c) {
    const double* here = f.row(c, row) + i;
    out.x[c].c[0] =
        scale * (load(here - 2) - load(here + 2) + 8 * (load(here + 1) - load(here - 1)));
    out.y[c].c[0] = scale * (load(f.row(c, row - 2) + i) - load(f.row(c, row + 2) + i) +
                             8 * (load(f.row(c, row + 1) + i) - load(f.row(c, row - 1) + i)));
  }
  return out;
}

/// The torus of revolution: cos and sin of a column are those of x, of a row those of y.
void start_rows(const Radii& radii, int n, GridRows& f) {
  std::vector<Eigen::Vector2d> columns(n);  // radius of the ring, height
  for (int i = 0; i < n; ++i) {
    const Eigen::Vector3d point = revolution_point(radii, {static_cast<double>(i) / n, 0});
    columns[i] << point.x(), point.z();
  }
  for (int r = f.first(); r < f.end(); ++r) {
    const double angle = 2 * std::numbers::pi * r / n;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    for (int i = 0; i < n; ++i) {
      f.row(0, r)[i] = columns[i].x() * cosine;
      f.row(1, r)[i] = columns[i].x() * sine;
      f.row(2, r)[i] = columns[i].y();
    }
    f.close(r);
  }
}

/// N pi(x) at four columns, its whole periods left out: N times a whole number over n.
Lane periods(const Corrugation& corrugation, int n, int row, int column) {
  const Eigen::Vector2d pi = kDirections[corrugation.direction].covector;
  Lane out;
  for (int l = 0; l < 4; ++l) {
    const auto steps =
        static_cast<std::int64_t>(pi.x()) * (column + l) + static_cast<std::int64_t>(pi.y()) * row;
    out[l] = static_cast<double>(steps * corrugation.number % n) / n;
  }
  return out;
}

/// One corrugation of the rows of `into`, from those of `from`.
void corrugate_rows(const TorusInput& input, int number, int n, const GridRows& from,
                    const GridRows& base, GridRows& into, BadNode& bad) {
  const Corrugation& corrugation = input.corrugations[number];
  for (int r = into.first(); r < into.end(); ++r) {
    for (int i = 0; i < n; i += 4) {
      const Differences now = differences(from, n, r, i);
      JetMetric<0> start;
      if (corrugation.begins_stage) {
        start = pulled_back(now.x, now.y);
      } else {
        const Differences before = differences(base, n, r, i);
        start = pulled_back(before.x, before.y);
      }
      const auto made = corrugate(now.x, now.y, toward_square(start, corrugation.share),
                                  corrugation, periods(corrugation, n, r, i));
      const int lanes = std::min(4, n - i);
      for (int l = 0; l < lanes; ++l) {
        for (int c = 0; c < 3; ++c)
          into.row(c, r)[i + l] = from.row(c, r)[i + l] + made.shift[c].c[0][l];
        const double rho = made.rho.c[0][l];
        if (!(rho > 0) && bad.corrugation < 0) bad = {number, r, i + l, rho};
      }
    }
    into.close(r);
  }
}

}  // namespace

void corrugate_band(const TorusInput& input, int n, int begin, int end,
                    std::vector<GridRows>& stages, BadNode& bad) {
  const int corrugations = static_cast<int>(stages.size()) - 1;
  for (int k = 0; k <= corrugations; ++k) {
    const int beyond = kRowReach * (corrugations - k);
    stages[k].hold(n, begin - beyond, end + beyond);
    if (k == 0) {
      start_rows(input.radii, n, stages[k]);
    } else {
      corrugate_rows(input, k - 1, n, stages[k - 1], stages[stage_base(input, k - 1)], stages[k],
                     bad);
    }
  }
}

}  // namespace geoprior::torus
