#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "core/options.h"
#include "models/paper/sheet.h"
#include "models/paper/sound_event.h"

namespace geoprior::paper {

/// Integral over time of the squared pressure, 1 m away, of what radiates from an event (Pa^2 s).
///
/// rho c / (4 pi) times the radiated energy, of which the share is 1e-4 for a free border of 0.1 m
/// and grows as the border (a plate far below its coincidence frequency, 277 kHz for office paper,
/// radiates at its edges: Maidanik 1962). The share is a guess of its size: it decides how loud
/// everything is, not how sounds compare.
/// @param energy       set free (J)
/// @param free_border  l_c (m)
double pressure_energy(double energy, double free_border);

/// One sound of a bank: pressure at a distance of 1 m (Pa) of an event of `energy`; of friction, of
/// root mean square 1.
struct BankSound {
  SoundKind kind = SoundKind::flap;
  double ruling_length = 0;      ///< l_r (m); of friction and tears unused
  double free_border = 0;        ///< l_c (m)
  double speed = 0;              ///< of friction (m/s)
  double energy = 1e-6;          ///< J
  Eigen::VectorXf samples = {};  ///< mono; friction repeats without a seam
};

/// Sounds to choose from.
struct SoundBank {
  int sample_rate = 48000;  ///< Hz
  std::vector<BankSound> sounds;

  /// Numbers of the sounds of a kind, ascending.
  [[nodiscard]] std::vector<int> of(SoundKind kind) const;
};

/// How a bank is generated. Nothing is recorded: docs/methods/paper-sound.md has the physics.
struct BankOptions {
  int sizes = 8;                                  ///< of l_r and of l_c each
  int variants = 2;                               ///< of flaps and of cracs for each pair
  double least_ruling = 5e-3, most_ruling = 0.3;  ///< l_r (m)
  double most_border = 0.6;                       ///< l_c (m)
  int speeds = 8;                                 ///< of friction
  double least_speed = 0.01, most_speed = 2;      ///< m/s
  int tears = 16;
  double damping = 0.03;   ///< loss factor eta
  double highest = 16000;  ///< Hz
  int most_modes = 400;    ///< of a sound
};
void describe(OptionVisitor& v, BankOptions& options);

/// Synthesises a bank from the plate's equations: the same material, options and seed give the same
/// samples at any number of threads.
///
/// A resonator is a plate of l_r by w, w its free border, or at least the shortest ruling of the
/// bank, simply supported where it meets the rest of the sheet:
///
///   f_mn = pi/2 sqrt(D/rho_s) ((m/l_r)^2 + (n/w)^2)          damped by exp(-pi eta f t)
///
/// up to `highest`, thinned at random to `most_modes`, with random phases. A mode is excited by the
/// spectrum of a raised cosine as long as the snap, radiates as sqrt(l_c + leak) f^(1/4) (edges of
/// a plate far below its coincidence frequency; leak: 5 mm, what a resonator without free border is
/// heard by), and sums to the energy. A flap is a snap of 1 to 3 ms and a few crackles of
/// it; a crac one of 0.05 to 0.2 ms. Friction is noise from 700 Hz to 6 kHz whose centroid rises
/// with the speed, modulated by stick and slip; a step of a tear is the break of a few fibres.
SoundBank generate_bank(const PaperMaterial& material, const BankOptions& options,
                        std::uint64_t seed);

/// FNV-1a of kinds, descriptors and samples: names a bank in records.
std::uint64_t checksum(const SoundBank& bank);

/// @throws Error  at `where`: no sounds of bends or cracs, descriptors that are negative or not
///                finite, a sound without samples or with one that is not finite
void require_valid(const SoundBank& bank, const std::string& where);

}  // namespace geoprior::paper
