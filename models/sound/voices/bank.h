#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/options.h"
#include "models/sound/events/event.h"
#include "models/sound/sheet.h"

namespace geoprior::sound {

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
  double width = 0;              ///< of its panel, across the rulings (m); 0: not known
  /// Roots of the beam equation of its lowest bending across and along the rulings: how it is held
  /// (`lowest_frequency`).
  double root_across = 4.73, root_along = 0;
  double bow = 0;  ///< curvature of its panel (1/m)
};

/// The numbers that describe a sound, under the names that files have for them, in the order in
/// which they are written down.
struct BankNumber {
  const char* name;
  double BankSound::*value;
};
inline constexpr std::array<BankNumber, 8> kBankNumbers{{{"l_r", &BankSound::ruling_length},
                                                         {"l_c", &BankSound::free_border},
                                                         {"width", &BankSound::width},
                                                         {"root_across", &BankSound::root_across},
                                                         {"root_along", &BankSound::root_along},
                                                         {"bow", &BankSound::bow},
                                                         {"speed", &BankSound::speed},
                                                         {"energy", &BankSound::energy}}};

/// Sounds to choose from.
struct SoundBank {
  int sample_rate = 48000;  ///< Hz
  std::vector<BankSound> sounds;

  /// Numbers of the sounds of a kind, ascending.
  [[nodiscard]] std::vector<int> of(SoundKind kind) const;
};

inline constexpr double kLeastPanelWidth = 3e-3;  ///< of the bank, across the rulings (m)

/// How a bank is generated. Nothing is recorded: docs/methods/sound.md has the physics.
struct BankOptions {
  int sizes = 8;
  int variants = 2;
  double damping = 0.03;
  double flap_bow = 10;
  double crac_bow = 25;
  double crackles = 0;
  double highest = 16000;
  int most_modes = 150;
};
void describe(OptionVisitor& v, BankOptions& options);

/// Synthesises a bank from the plate's equations: the same material, options and seed give the same
/// samples at any number of threads.
///
/// A resonator is a rectangle of l_r along its rulings and w across them (sound_panel.h), of which
/// a half or more flips: its modes get their amplitudes from that and radiate as dipoles, with
/// phases drawn at random, damped by exp(-pi eta f t). How l_c follows from w depends on what holds
/// it, so that variants and neighbours differ: between two creases, rulings that end at free
/// borders on both sides (l_c = 2 w) or on one (w); hanging on one crease (l_r + 2 w) or on none
/// (2 l_r + 2 w); with creases (nearly) all around w is two thirds of l_r, one and a half or three
/// times. How far it is bent across its rulings is drawn, up to `flap_bow` or `crac_bow`. A flap is
/// a snap of 1 to 3 ms, a crac one of 0.05 to 0.2 ms. Friction is noise from
/// 700 Hz to 6 kHz whose centroid rises with the speed, modulated by stick and slip; a step of a
/// tear is the break of a few fibres.
SoundBank generate_bank(const PaperMaterial& material, const BankOptions& options,
                        std::uint64_t seed);

/// FNV-1a of kinds, descriptors and samples: names a bank in records.
std::uint64_t checksum(const SoundBank& bank);
/// Its lowest 48 bits, which a double holds exactly: what runs record.
double recorded_checksum(const SoundBank& bank);

/// @throws Error  at `where`: no sounds of bends or cracs, descriptors that are negative or not
///                finite, a sound without samples or with one that is not finite
void require_valid(const SoundBank& bank, const std::string& where);

}  // namespace geoprior::sound
