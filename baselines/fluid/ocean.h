#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/mesh.h"
#include "core/method.h"
#include "core/options.h"

namespace geoprior {

enum class SpectrumKind { phillips, pierson_moskowitz, jonswap, tma };
enum class SpreadingKind { none, cosine_squared, mitsuyasu, one_sided };

/// A periodic patch of wind sea, z up.
struct OceanOptions {
  SpectrumKind spectrum = SpectrumKind::jonswap;
  SpreadingKind spreading = SpreadingKind::cosine_squared;
  int samples = 128;              ///< N x N of the patch, a power of two
  double size = 100;              ///< L, edge of the patch (m)
  double wind_speed = 10;         ///< U at 10 m (m/s)
  double wind_direction_deg = 0;  ///< where it blows to, from +x towards +y
  double fetch = 100e3;           ///< F (m): JONSWAP, TMA
  double depth = 1000;            ///< H (m)
  double gravity = 9.81;
  double choppiness = 1;     ///< lambda of the horizontal displacement
  double smallest_wave = 0;  ///< waves shorter than this are damped (m)
  double amplitude = 0;      ///< significant wave height to scale to (m); 0: as the spectrum says
  double mean_level = 0;     ///< z of the rest surface (m)
  int tiles = 1;             ///< the patch repeated this many times along x and y
  double duration = 2;       ///< s
  double frame_interval = 1.0 / 25;
};
void describe(OptionVisitor& v, OceanOptions& options);

/// h(x, t) = sum over k of [h0(k) e^{-i w t} + conj(h0(-k)) e^{+i w t}] e^{i k x}, with
/// h0(k) = (xr + i xi)/2 sqrt(P(k) dkx dky): variance of h = integral of P; every mode moves at its
/// own w(k), w^2 = g k tanh(k H), waves run downwind.
/// Sources: Tessendorf 2004; Horvath 2015; thesis 3.3.
class Ocean {
 public:
  Ocean(const OceanOptions& options, std::uint64_t seed);
  ~Ocean();
  /// Heights of the N x N patch at a time, x fastest (m).
  [[nodiscard]] Eigen::VectorXd heights(double time) const;
  /// Displacements (dx, dy, h) of the samples, choppiness included (m).
  [[nodiscard]] Eigen::MatrixX3d displacements(double time) const;
  /// Velocities of the displaced samples: the exact time derivative (m/s).
  [[nodiscard]] Eigen::MatrixX3d velocities(double time) const;
  /// Angular frequency of a mode (rad/s); kx, ky whole numbers of waves along the patch.
  [[nodiscard]] double frequency(int kx, int ky) const;
  /// Variance that the modes of the patch carry in expectation (m^2): sum of P dkx dky.
  [[nodiscard]] double expected_variance() const;
  /// The tiled surface; border vertices of neighbouring tiles are shared.
  [[nodiscard]] TriMesh surface(double time, Eigen::MatrixX3d* velocity = nullptr) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

/// Directional spectrum P(k) (m^4) at a wave vector (rad/m).
double ocean_spectrum(const OceanOptions& options, const Eigen::Vector2d& k);

/// Frames "surface" with point array "velocity" at multiples of the interval.
std::unique_ptr<Process> make_ocean(const OceanOptions& options);

}  // namespace geoprior
