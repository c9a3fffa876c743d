#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/mesh.h"
#include "core/method.h"
#include "core/options.h"

namespace geoprior::fluid {

enum class SpectrumKind { phillips, pierson_moskowitz, jonswap, tma };
/// Share D(theta) of the directions, theta from the wind, integral 1. `none`: all alike, 1/(2 pi);
/// `cosine_squared`: 2/pi cos^2 downwind, 0 upwind; `mitsuyasu`: cos^2s(theta/2), s falls away from
/// the peak; `one_sided`: 1/pi downwind, 0 upwind.
enum class SpreadingKind { none, cosine_squared, mitsuyasu, one_sided };

/// A periodic patch of wind sea, z up.
struct OceanOptions {
  SpectrumKind spectrum = SpectrumKind::jonswap;
  SpreadingKind spreading = SpreadingKind::cosine_squared;
  int samples = 128;
  double size = 100;
  double wind_speed = 10;
  double wind_direction_deg = 0;
  double fetch = 100e3;
  double peak_enhancement = 3.3;
  double depth = 1000;
  double gravity = 9.81;
  double choppiness = 1;
  double smallest_wave = 0;  ///< damping exp(-(k s/2pi)^2)
  std::optional<double> amplitude;
  double mean_level = 0;
  int tiles = 1;
};
void describe(OptionVisitor& v, OceanOptions& options);

/// @throws Error  naming the option: samples no power of two, a number that is not finite or not
///                positive, more than 4096 samples or 8192 x 8192 vertices
void require_valid(const OceanOptions& options, const std::string& where);

/// h(x, t) = sum over k of [h0(k) e^{-i w t} + conj(h0(-k)) e^{+i w t}] e^{i k x}, with
/// h0(k) = (xr + i xi)/2 sqrt(P(k) dkx dky): variance of h = integral of P; every mode moves at its
/// own w(k), w^2 = g k tanh(k H), waves run downwind.
///
/// Points move by (lambda D, h), D = i k/|k| h mode by mode: round orbits, crests pointed (for
/// lambda <= 1 / slope; beyond, crests fold over). The rest state and the Nyquist modes
/// (|kx| or |ky| = N/2 waves) carry nothing: samples cannot tell their direction. A mode has the
/// same random numbers whatever N is, so that a finer patch adds short waves to the same sea.
/// What it cannot do: breaking, swell that meets an obstacle, waves longer than the patch.
/// Sources: Tessendorf 2004; Horvath 2015; thesis 3.3.
class Ocean {
 public:
  /// @throws Error  as `require_valid`
  Ocean(const OceanOptions& options, std::uint64_t seed);
  ~Ocean();
  /// Heights over the rest level of the N x N patch at a time, x fastest (m); sample (i, j) is at
  /// (i, j) L/N.
  [[nodiscard]] Eigen::VectorXd heights(double time) const;
  /// Displacements (dx, dy, h) of the samples, choppiness included (m).
  [[nodiscard]] Eigen::MatrixX3d displacements(double time) const;
  /// Velocities of the displaced samples: the exact time derivative (m/s).
  [[nodiscard]] Eigen::MatrixX3d velocities(double time) const;
  /// Angular frequency of a mode (rad/s); kx, ky whole numbers of waves along the patch.
  [[nodiscard]] double frequency(int kx, int ky) const;
  /// Variance that the modes of the patch carry in expectation (m^2): sum of P dkx dky.
  [[nodiscard]] double expected_variance() const;
  /// The tiled surface, centred at the origin, (N tiles + 1)^2 vertices, x fastest; border vertices
  /// of neighbouring tiles are shared.
  [[nodiscard]] TriMesh surface(double time, Eigen::MatrixX3d* velocity = nullptr) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Vertices of the tiled surface.
double vertices_of(const OceanOptions& options);

/// Directional spectrum P(k) (m^4) at a wave vector (rad/m), before scaling to `amplitude`:
/// P = S(w) D(theta) (dw/dk) / k, integral over the plane = m0.
///
/// S: Pierson and Moskowitz 1964; Hasselmann et al. 1973 (JONSWAP); Bouws et al. 1985 (TMA:
/// Kitaigorodskii's factor of depth, exact). Phillips has P = alpha/2 exp(-1/(k U^2/g)^2) k^-4 D,
/// alpha = 0.0081, in any depth. Spreading: Mitsuyasu et al. 1975.
double ocean_spectrum(const OceanOptions& options, const Eigen::Vector2d& k);

/// Angular frequency of waves of wave number k (rad/m): w^2 = g k tanh(k H).
double ocean_frequency(const OceanOptions& options, double k);

/// Frames at the times given: the part "surface" (triangles, point array "velocity" [m/s]); the
/// part "samples" (grid of the patch's N x N samples, arrays "height" [m] and "rate" [m/s], its
/// time derivative); the table "sea" (depth, gravity, wind direction, variance that the spectrum
/// expects). Diagnostic: `folded_triangles` (of the surface, turned over by choppiness).
/// @param times  strictly increasing (s)
std::unique_ptr<Process> make_ocean(const OceanOptions& options, std::vector<double> times);

}  // namespace geoprior::fluid
