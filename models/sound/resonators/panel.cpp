#include "models/sound/resonators/panel.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "models/sound/voices/air.h"
#include "models/sound/voices/ring.h"

namespace geoprior::sound {
namespace {

using std::numbers::pi;

constexpr int kMostAcross = 40;  // modes of the beam across the rulings
constexpr int kMostAlong = 8;    // along them: flips are smooth

double beta_of(BeamEnds ends, int n) {
  // Roots of cos b cosh b = 1 and of cos b cosh b = -1; beyond the first ones those of the cosine.
  static constexpr std::array<double, 4> kEqual{4.730040744862704, 7.853204624095838,
                                                10.995607838001671, 14.137165491257464};
  static constexpr std::array<double, 4> kCantilever{1.875104068711961, 4.694091132974175,
                                                     7.854757438237613, 10.995540734875467};
  const int i = ends == BeamEnds::free_free ? n - 2 : n;
  if (i < 4) return (ends == BeamEnds::clamped_free ? kCantilever : kEqual)[i];
  return ends == BeamEnds::clamped_free ? (i + 0.5) * pi : (i + 1.5) * pi;
}

/// A beam mode with the integrals that a panel needs, over the midpoints of equal pieces.
struct Sampled {
  BeamMode mode;
  Eigen::ArrayXd x, value;
  double bend = 0;   ///< integral of psi psi''
  double slope = 0;  ///< of psi'^2
  double part = 0;   ///< of psi over what flips
  double turn = 0;   ///< psi' at its end less psi' at its start

  Sampled(BeamEnds ends, int n, double from, double to) : mode(ends, n) {
    const int count = 12 * (n + 3);
    x = (Eigen::ArrayXd::LinSpaced(count, 0, count - 1) + 0.5) / count;
    value = x.unaryExpr([&](double at) { return mode.value(at); });
    for (int i = 0; i < count; ++i) {
      bend += value[i] * mode.bend(x[i]) / count;
      slope += std::pow(mode.slope(x[i]), 2) / count;
    }
    for (int i = 0; i < count; ++i) part += mode.value(from + (to - from) * x[i]);
    part *= (to - from) / count;
    turn = mode.slope(to) - mode.slope(from);
  }
  /// Squared modulus of the integral of psi exp(-i k x).
  [[nodiscard]] double spectrum(double k) const {
    const Eigen::ArrayXd phase = k * x;
    const auto n = static_cast<double>(x.size());
    return (std::pow((value * phase.cos()).sum(), 2) + std::pow((value * phase.sin()).sum(), 2)) /
           (n * n);
  }
};

/// One eighth of the sphere: |x|, |y|, |z| of evenly spread directions.
std::vector<Eigen::Vector3d> octant() {
  constexpr int kDirections = 9;
  std::vector<Eigen::Vector3d> all;
  const double turn = pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z);
    all.emplace_back(std::abs(r * std::cos(turn * i)), std::abs(r * std::sin(turn * i)),
                     std::abs(z));
  }
  return all;
}

/// Square of the angular frequency that being bent gives a panel (1/s^2), of wave numbers (1/m).
double stiffening(const SoundPanel& panel, double along, double across,
                  const PaperMaterial& material) {
  if (panel.bow == 0 || along == 0) return 0;
  const double share = along * along / (along * along + across * across);
  return material.young_modulus * material.thickness / material.area_density *
         std::pow(panel.bow * share, 2);
}

/// A mode of a panel before its pressure is known: the beams' modes it is made of.
struct Found {
  PanelMode mode;
  std::size_t n, j;
  double coordinate, wave_square;
};

}  // namespace

BeamMode::BeamMode(BeamEnds ends, int n) : n_(n) {
  rigid_ = ends == BeamEnds::free_free && n < 2;
  if (rigid_) return;
  beta_ = beta_of(ends, n);
  const double c = std::cos(beta_), s = std::sin(beta_), e = std::exp(-beta_);
  // cosh b and sinh b over exp(b).
  const double cosh = (1 + e * e) / 2, sinh = (1 - e * e) / 2;
  double rest = 0;  // (1 - sigma) exp(b)
  if (ends == BeamEnds::clamped_free) {
    sigma_ = (sinh - s * e) / (cosh + c * e);
    rest = (e + c + s) / (cosh + c * e);
  } else {
    sigma_ = (cosh - c * e) / (sinh - s * e);
    rest = (c - s - e) / (sinh - s * e);
  }
  near_ = (1 + sigma_) / 2;
  far_ = rest / 2;
  sign_ = ends == BeamEnds::free_free ? 1 : -1;
}

double BeamMode::trigonometric(double x) const {
  if (rigid_) return n_ == 0 ? 1 : std::sqrt(3.0) * (2 * x - 1);
  return sign_ * (std::cos(beta_ * x) - sigma_ * std::sin(beta_ * x));
}

double BeamMode::hyperbolic(double x) const {
  if (rigid_) return 0;
  return near_ * std::exp(-beta_ * x) + far_ * std::exp(-beta_ * (1 - x));
}

double BeamMode::slope(double x) const {
  if (rigid_) return n_ == 0 ? 0 : 2 * std::sqrt(3.0);
  return beta_ * (-sign_ * (std::sin(beta_ * x) + sigma_ * std::cos(beta_ * x)) -
                  near_ * std::exp(-beta_ * x) + far_ * std::exp(-beta_ * (1 - x)));
}

double BeamMode::bend(double x) const { return beta_ * beta_ * (hyperbolic(x) - trigonometric(x)); }

std::vector<PanelMode> panel_modes(const SoundPanel& panel, const PaperMaterial& material,
                                   double tau, double highest, int most) {
  const double nu = material.poisson_ratio, w = panel.width, l = panel.length;
  const double stiffness = std::sqrt(material.bending_stiffness() / material.area_density);
  std::vector<Sampled> across, along;
  for (int n = 0; n < kMostAcross; ++n)
    across.emplace_back(panel.across, n, panel.across_from, panel.across_to);
  for (int j = 0; j < kMostAlong; ++j)
    along.emplace_back(panel.along, j, panel.along_from, panel.along_to);

  std::vector<Found> all;
  for (std::size_t n = 0; n < across.size(); ++n) {
    for (std::size_t j = 0; j < along.size(); ++j) {
      const Sampled &a = across[n], &b = along[j];
      const double square =
          std::pow(a.mode.beta() / w, 4) + std::pow(b.mode.beta() / l, 4) +
          2 / (w * w * l * l) * (nu * a.bend * b.bend + (1 - nu) * a.slope * b.slope);
      const double omega =
          std::sqrt(stiffness * stiffness * std::max(square, 0.0) +
                    stiffening(panel, b.mode.beta() / l, a.mode.beta() / w, material));
      const double f = omega / (2 * pi);
      constexpr double kRigid = 1e-3;  // Hz: what does not ring
      if (f < kRigid || f > highest) continue;
      // Of a mode of unit mass, but for factors that all have.
      const double force =
          (a.turn / w * l * b.part + nu * b.turn / l * w * a.part) / std::sqrt(w * l);
      const double q = force / (omega * omega) * pulse_spectrum(f, tau);
      all.push_back({{f, omega * omega * q * q / 2, 0},
                     n,
                     j,
                     std::abs(q),
                     a.slope / (w * w) + b.slope / (l * l)});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Found& a, const Found& b) { return a.mode.energy > b.mode.energy; });
  all.resize(std::min(all.size(), static_cast<std::size_t>(most)));
  static const std::vector<Eigen::Vector3d> directions = octant();
  std::vector<PanelMode> modes;
  for (Found& found : all) {
    const double omega = 2 * pi * found.mode.frequency, k = omega / kSoundSpeed;
    double mean = 0;
    for (const Eigen::Vector3d& d : directions) {
      mean += d.z() * d.z() * across[found.n].spectrum(k * d.x() * w) *
              along[found.j].spectrum(k * d.y() * l) / static_cast<double>(directions.size());
    }
    // k times the jump times the integral; factors that all modes have are left out.
    found.mode.pressure = k * pressure_jump(omega, found.wave_square, w * l) * found.coordinate *
                          std::sqrt(w * l) * std::sqrt(mean);
    modes.push_back(found.mode);
  }
  std::stable_sort(modes.begin(), modes.end(), [](const PanelMode& a, const PanelMode& b) {
    return a.frequency < b.frequency;
  });
  return modes;
}

double lowest_frequency(const SoundPanel& panel, double root_along, double root_across,
                        const PaperMaterial& material) {
  const double along = root_along / panel.length;
  double lowest = std::numeric_limits<double>::infinity();
  for (int n = 0; n < kMostAcross; ++n) {
    const double across = (root_across + n * pi) / panel.width;
    const double flat = material.bending_stiffness() / material.area_density *
                        (std::pow(along, 4) + std::pow(across, 4));
    lowest = std::min(lowest, flat + stiffening(panel, along, across, material));
  }
  return std::sqrt(lowest) / (2 * pi);
}

}  // namespace geoprior::sound
