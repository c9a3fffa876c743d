#include "models/sound/voices/bank.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"
#include "models/sound/resonators/panel.h"
#include "models/sound/voices/air.h"
#include "models/sound/voices/ring.h"

namespace geoprior::sound {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLeak = 5e-3;  // m: border that a resonator without free border radiates by

// What resonators of sheets up to A3 have: lengths along rulings, free borders (m), speeds of
// slipping (m/s).
constexpr double kLeastRuling = 5e-3, kMostRuling = 0.3, kMostBorder = 0.6;
constexpr double kLeastSpeed = 0.01, kMostSpeed = 2;
// Loops of friction and steps of tears: so many that none is heard again at once (a choice).
constexpr int kSpeeds = 8, kVariantsOfFriction = 8, kSteps = 16;

double uniform(RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// `count` values from low to high in equal ratios.
std::vector<double> ratios(double low, double high, int count) {
  std::vector<double> all;
  for (int i = 0; i < count; ++i) {
    all.push_back(count == 1 ? std::sqrt(low * high)
                             : low * std::pow(high / low, i / (count - 1.0)));
  }
  return all;
}

/// Panels that the descriptors may belong to: they do not say how it is held.
std::vector<SoundPanel> panels_of(double l_r, double l_c) {
  using enum BeamEnds;
  const auto panel = [&](double width, BeamEnds along, BeamEnds across) {
    return SoundPanel{.length = l_r,
                      .width = std::max(width, kLeastPanelWidth),
                      .along = along,
                      .across = across};
  };
  std::vector<SoundPanel> all;
  // Creases all around, or nearly so.
  if (l_c < l_r) {
    for (const double aspect : {2 / 3.0, 1.5, 3.0})
      all.push_back(panel(aspect * l_r, clamped_clamped, clamped_clamped));
  }
  if (l_c < kLeastRuling / 2) return all;
  constexpr double kMargin = 1.2;  // below, the width would be next to nothing
  // Between two creases, rulings that end at free borders on both sides, or on one.
  all.push_back(panel(l_c / 2, free_free, clamped_clamped));
  all.push_back(panel(l_c, clamped_free, clamped_clamped));
  // It hangs on one crease along a ruling, or on none.
  if (l_c > kMargin * l_r) all.push_back(panel((l_c - l_r) / 2, free_free, clamped_free));
  if (l_c > 2 * kMargin * l_r) all.push_back(panel(l_c / 2 - l_r, free_free, free_free));
  return all;
}

/// One of them, another one for each variant; a half or more of it flips in either direction.
SoundPanel panel_of(double l_r, double l_c, int variant, RandomStream& random) {
  const std::vector<SoundPanel> all = panels_of(l_r, l_c);
  SoundPanel panel = all[static_cast<std::size_t>(variant) % all.size()];
  const auto flips = [&](double& from, double& to) {
    const double share = uniform(random, 0.5, 1);
    from = (1 - share) * random.uniform();
    to = from + share;
  };
  flips(panel.along_from, panel.along_to);
  flips(panel.across_from, panel.across_to);
  return panel;
}

/// Adds a snap of a panel, as long as it is heard. Loudness is decided afterwards.
void add_snap(const SoundPanel& panel, double tau, double gain, double start,
              const BankOptions& options, const PaperMaterial& material, int rate,
              RandomStream& random, Eigen::VectorXd& out) {
  std::vector<PanelMode> modes =
      panel_modes(panel, material, tau, options.highest, options.most_modes);
  // A facet too small to be heard but as a click.
  if (modes.empty()) modes = {{options.highest, 1, 1}};
  double energy = 0;
  for (const PanelMode& mode : modes) energy += mode.energy;
  if (!(energy > 0)) return;
  // Modes below the lowest that is heard are there, and are over when it is.
  constexpr double kLongest = 0.6, kHeard = 40;  // s, Hz
  double lowest = options.highest;
  for (const PanelMode& mode : modes) lowest = std::min(lowest, mode.frequency);
  const double length =
      std::min(kLongest, ringing_time(std::max(lowest, kHeard), options.damping)) + tau + 0.02;
  Eigen::VectorXd sound = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(length * rate));
  for (const PanelMode& mode : modes) {
    add_ringing(
        {mode.frequency, gain * mode.pressure / std::sqrt(energy), uniform(random, 0, 2 * kPi)},
        options.damping, rate, 0, sound);
  }
  fade_in(sound, 0, tau, rate);
  fade_out(sound, rate);
  const auto first = static_cast<Eigen::Index>(start * rate);
  if (out.size() < first + sound.size()) {
    out.conservativeResizeLike(Eigen::VectorXd::Zero(first + sound.size()));
  }
  out.segment(first, sound.size()) += sound;
}

/// Snaps of facets that follow a flap, with energies p(E) ~ E^-1.45 over three decades.
void add_crackles(const BankOptions& options, const PaperMaterial& material, int rate,
                  RandomStream& random, Eigen::VectorXd& out) {
  constexpr double kSpread = 0.06;  // s: over which they follow it
  const int count = 3 + static_cast<int>(random.below(6));
  std::vector<double> energy;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double u = random.uniform(), a = -0.45, low = 1, high = 1000;
    energy.push_back(
        std::pow(std::pow(low, a) + u * (std::pow(high, a) - std::pow(low, a)), 1 / a));
    sum += energy.back();
  }
  for (const double e : energy) {
    const double size = uniform(random, 5e-3, 20e-3);
    const SoundPanel facet = panel_of(size, 0, 0, random);
    add_snap(facet, uniform(random, 5e-5, 2e-4), std::sqrt(options.crackles * e / sum),
             kSpread * random.uniform(), options, material, rate, random, out);
  }
}

/// Roots of the beam equation of a panel's lowest bending along and across; 0 of free ends along,
/// where it swings as one.
void describe_panel(const SoundPanel& panel, BankSound& sound) {
  const auto root = [](BeamEnds ends) {
    return BeamMode(ends, ends == BeamEnds::free_free ? 2 : 0).beta();
  };
  sound.width = panel.width;
  sound.bow = panel.bow;
  sound.root_across = root(panel.across);
  sound.root_along = panel.along == BeamEnds::free_free ? 0 : root(panel.along);
}

/// A flap is a snap of 1 to 3 ms, with crackles if the options say so; a crac one of 0.05 to 0.2
/// ms.
Eigen::VectorXd snap(BankSound& sound, int variant, const BankOptions& options,
                     const PaperMaterial& material, int rate, RandomStream& random) {
  const bool flaps = sound.kind == SoundKind::flap;
  const double crackles = flaps ? options.crackles : 0;
  SoundPanel panel = panel_of(sound.ruling_length, sound.free_border, variant, random);
  panel.bow = (flaps ? options.flap_bow : options.crac_bow) * random.uniform();
  describe_panel(panel, sound);
  const double tau = flaps ? uniform(random, 1e-3, 3e-3) : uniform(random, 5e-5, 2e-4);
  Eigen::VectorXd out;
  add_snap(panel, tau, std::sqrt(1 - crackles), 0, options, material, rate, random, out);
  if (crackles > 0) add_crackles(options, material, rate, random, out);
  return out;
}

/// Noise of a band, by a two-pole filter run twice round: it repeats without a seam.
Eigen::VectorXd friction(double speed, int rate, RandomStream& random) {
  constexpr double kLength = 1.0;  // s
  const auto n = static_cast<Eigen::Index>(kLength * rate);
  const double share = std::log(speed / kLeastSpeed) / std::log(kMostSpeed / kLeastSpeed);
  const double centre = 1200 * std::pow(3.0, std::clamp(share, 0.0, 1.0));
  Eigen::VectorXd noise(n), out = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i) noise[i] = random.normal();
  // State-variable band-pass (Chamberlin) of quality 0.8.
  const double f = 2 * std::sin(kPi * centre / rate), q = 1 / 0.8;
  double low = 0, band = 0;
  for (int round = 0; round < 2; ++round) {
    for (Eigen::Index i = 0; i < n; ++i) {
      low += f * band;
      band += f * (noise[i] - low - q * band);
      out[i] = band;
    }
  }
  // Stick and slip, whole periods in the loop.
  const double beats = std::round(kLength * (20 + 60 * std::clamp(share, 0.0, 1.0)));
  const double phase = uniform(random, 0, 2 * kPi);
  for (Eigen::Index i = 0; i < n; ++i) {
    out[i] *=
        0.7 +
        0.3 * std::sin(2 * kPi * beats * static_cast<double>(i) / static_cast<double>(n) + phase);
  }
  return out / std::sqrt(out.squaredNorm() / static_cast<double>(n));
}

/// A few fibres that break, each a facet of some mm.
Eigen::VectorXd tear(const BankOptions& options, const PaperMaterial& material, int rate,
                     RandomStream& random) {
  Eigen::VectorXd out;
  const int fibres = 2 + static_cast<int>(random.below(5));
  for (int i = 0; i < fibres; ++i) {
    const double size = uniform(random, 3e-3, 8e-3);
    const SoundPanel facet = panel_of(size, 2 * size, 0, random);
    add_snap(facet, uniform(random, 3e-5, 1e-4), 1 / std::sqrt(fibres), 8e-3 * random.uniform(),
             options, material, rate, random, out);
  }
  return out;
}

}  // namespace

double pressure_energy(double energy, double free_border) {
  constexpr double kImpedance = kAirDensity * kSoundSpeed;  // Pa s/m
  constexpr double kRadiatedShare = 1e-4;                   // by a free border of kBorder
  constexpr double kBorder = 0.1;                           // m
  const double radiated = kRadiatedShare * (free_border + kLeak) / kBorder * energy;
  return kImpedance / (4 * kPi) * radiated;
}

std::vector<int> SoundBank::of(SoundKind kind) const {
  std::vector<int> all;
  for (int i = 0; i < std::ssize(sounds); ++i) {
    if (sounds[i].kind == kind) all.push_back(i);
  }
  return all;
}

void describe(OptionVisitor& v, BankOptions& o) {
  v.value("sizes", o.sizes,
          {.doc = "lengths l_r along rulings in the bank, and as many lengths l_c of free border",
           .min = 1,
           .max = 64});
  v.value("variants", o.variants,
          {.doc = "flaps, and as many cracs, in the bank for each pair of lengths",
           .min = 1,
           .max = 64});
  v.value("damping", o.damping,
          {.doc = "loss factor eta of the paper of the bank", .min = 1e-4, .max = 1});
  v.value("flap_bow", o.flap_bow,
          {.doc = "largest curvature of a flap's panel", .unit = "1/m", .min = 0, .max = 1000});
  v.value("crac_bow", o.crac_bow,
          {.doc = "largest curvature of a crac's panel", .unit = "1/m", .min = 0, .max = 1000});
  v.value("crackles", o.crackles,
          {.doc = "share of a flap's energy in snaps of small facets that follow it",
           .min = 0,
           .max = 0.99});
  v.value(
      "highest", o.highest,
      {.doc = "highest frequency of a mode in the bank", .unit = "Hz", .min = 100, .max = 20000});
  v.value("most_modes", o.most_modes,
          {.doc = "modes of a sound of the bank, those of most energy", .min = 1, .max = 100000});
}

SoundBank generate_bank(const PaperMaterial& material, const BankOptions& options,
                        std::uint64_t seed) {
  SoundBank bank;
  const std::vector<double> rulings = ratios(kLeastRuling, kMostRuling, options.sizes);
  std::vector<double> borders{0};
  if (options.sizes > 1) {
    const std::vector<double> more = ratios(kLeastRuling, kMostBorder, options.sizes - 1);
    borders.insert(borders.end(), more.begin(), more.end());
  }
  for (const double l_r : rulings) {
    for (const double l_c : borders) {
      for (const SoundKind kind : {SoundKind::flap, SoundKind::crac}) {
        for (int i = 0; i < options.variants; ++i) bank.sounds.push_back({kind, l_r, l_c});
      }
    }
  }
  for (const double speed : ratios(kLeastSpeed, kMostSpeed, kSpeeds)) {
    for (int i = 0; i < kVariantsOfFriction; ++i) {
      bank.sounds.push_back({SoundKind::friction, 0, 0, speed});
    }
  }
  for (int i = 0; i < kSteps; ++i) bank.sounds.push_back({SoundKind::tear});
  parallel_blocks(bank.sounds.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      BankSound& sound = bank.sounds[i];
      RandomStream random(seed, "paper sound bank " + std::to_string(i));
      const int rate = bank.sample_rate;
      // Neighbouring sizes have other panels: i counts variants, kinds and sizes.
      const int variant = static_cast<int>(i) % options.variants +
                          static_cast<int>(i) / (2 * options.variants) * options.variants;
      Eigen::VectorXd samples;
      switch (sound.kind) {
        case SoundKind::flap:
        case SoundKind::crac:
          samples = snap(sound, variant, options, material, rate, random);
          break;
        case SoundKind::friction:
          samples = friction(sound.speed, rate, random);
          break;
        case SoundKind::tear:
          samples = tear(options, material, rate, random);
          break;
      }
      if (sound.kind != SoundKind::friction) {
        const double loud = pressure_energy(sound.energy, sound.free_border) * rate;
        samples *= std::sqrt(loud / std::max(samples.squaredNorm(), 1e-300));
      }
      sound.samples = samples.cast<float>();
    }
  });
  return bank;
}

std::uint64_t checksum(const SoundBank& bank) {
  std::uint64_t hash = 14695981039346656037ull;
  const auto add = [&](std::uint32_t word) {
    for (int byte = 0; byte < 4; ++byte) {
      hash = (hash ^ ((word >> (8 * byte)) & 255)) * 1099511628211ull;
    }
  };
  const auto add_number = [&](double x) {
    add(std::bit_cast<std::uint32_t>(static_cast<float>(x)));
  };
  add(static_cast<std::uint32_t>(bank.sample_rate));
  for (const BankSound& sound : bank.sounds) {
    add(static_cast<std::uint32_t>(sound.kind));
    for (const BankNumber& number : kBankNumbers) add_number(sound.*number.value);
    for (const float x : sound.samples) add(std::bit_cast<std::uint32_t>(x));
  }
  return hash;
}

double recorded_checksum(const SoundBank& bank) {
  return static_cast<double>(checksum(bank) & ((std::uint64_t{1} << 48) - 1));
}

void require_valid(const SoundBank& bank, const std::string& where) {
  for (std::size_t i = 0; i < bank.sounds.size(); ++i) {
    const BankSound& sound = bank.sounds[i];
    const std::string place = where + ": sound " + std::to_string(i);
    if (sound.samples.size() == 0) throw Error("has no samples", place);
    if (!sound.samples.allFinite()) throw Error("has a sample that is not finite", place);
    for (const BankNumber& number : kBankNumbers) {
      const double x = sound.*number.value;
      if (!(x >= 0) || !std::isfinite(x)) {
        throw Error(std::string(number.name) + " is " + std::to_string(x), place, "0 or more");
      }
    }
  }
  if (bank.of(SoundKind::flap).empty() && bank.of(SoundKind::crac).empty()) {
    throw Error("has no sound of a flap or crac", where, "one at least");
  }
}

}  // namespace geoprior::sound
