#pragma once

#include <vector>

#include "models/sound/sheet.h"

namespace geoprior::sound {

/// How the two ends of a beam are held.
enum class BeamEnds { free_free, clamped_clamped, clamped_free };

/// Mode n = 0, 1, … of a beam of length 1: psi'''' = beta^4 psi, integral of psi^2 = 1. The first
/// two of a free beam are its rigid motions.
class BeamMode {
 public:
  BeamMode(BeamEnds ends, int n);
  [[nodiscard]] double beta() const { return beta_; }
  [[nodiscard]] double value(double x) const { return trigonometric(x) + hyperbolic(x); }
  [[nodiscard]] double slope(double x) const;
  [[nodiscard]] double bend(double x) const;  ///< psi''

 private:
  [[nodiscard]] double trigonometric(double x) const;
  [[nodiscard]] double hyperbolic(double x) const;

  bool rigid_ = false;
  int n_ = 0;
  double beta_ = 0;
  /// sign (cos beta x - sigma sin beta x) + near exp(-beta x) + far exp(-beta (1 - x)): the sums of
  /// growing exponentials that cancel each other are done by hand.
  double sign_ = 1, sigma_ = 0, near_ = 0, far_ = 0;
};

/// A rectangle of paper that rings: `length` along its rulings, `width` across them.
struct SoundPanel {
  double length = 0, width = 0;  ///< m
  double bow = 0;                ///< curvature across the rulings (1/m)
  BeamEnds along = BeamEnds::free_free, across = BeamEnds::clamped_clamped;
  /// What flips: from … to along and across, as shares of the panel.
  double along_from = 0, along_to = 1, across_from = 0, across_to = 1;
};

/// A mode that a strike has left.
struct PanelMode {
  double frequency = 0;  ///< Hz
  double energy = 0;     ///< relative to the other modes
  double pressure = 0;   ///< relative, root mean square over directions
};

/// Modes of the panel after the flip, those of most energy, ascending in frequency.
///
/// Shapes are products of beam modes, frequencies Rayleigh's quotients of them (Warburton 1954): a
/// few per cent above the plate's own. A panel that is bent across its rulings is stiffer against
/// all that waves along them, by (E h / rho_s) bow^2 (k_l^2 / (k_l^2 + k_w^2))^2 in omega^2 with
/// the wave numbers along and across (Donnell's equations of a shallow shell; none for rulings that
/// stay straight). The flip changes the curvature across the rulings by dS in
/// its rectangle, with which mode phi gets the coordinate q = g / omega^2 |P(f tau)|,
///
///   g = -D dS integral of (phi_xx + nu phi_yy),
///
/// P the spectrum of a raised cosine of length tau. A mode radiates as a layer of dipoles, whose
/// strength is the difference of the pressures on both sides (`pressure_jump`, sound_air.h): the
/// rule of baselines/sound/modal/modal.h.
///
/// @param tau      length of the snap (s)
/// @param highest  frequency (Hz)
/// @param most     modes
std::vector<PanelMode> panel_modes(const SoundPanel& panel, const PaperMaterial& material,
                                   double tau, double highest, int most);

/// The lowest frequency (Hz) of a panel whose lowest bending has the roots of the beam equation
/// `root_along` (0: rulings stay straight) and `root_across`; higher ones across are taken to be
/// pi apart, and the term of twist is left out. How high a panel rings, to within an eighth.
double lowest_frequency(const SoundPanel& panel, double root_along, double root_across,
                        const PaperMaterial& material);

}  // namespace geoprior::sound
