#include "models/paper/sound_bank.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <string_view>

#include "core/error.h"
#include "core/parallel.h"
#include "core/random.h"

namespace geoprior::paper {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLeak = 5e-3;     // m: border that a resonator without free border radiates by
constexpr double kSilence = 1e-3;  // of its loudest moment, at which a mode is over

/// A damped sine.
struct Mode {
  double frequency = 0;  ///< Hz
  double amplitude = 0;
  double phase = 0;
};

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

/// Magnitude of the spectrum of a raised cosine of length tau and area 1: 1 at f = 0.
double pulse_spectrum(double f, double tau) {
  const double x = f * tau;
  if (std::abs(x - 1) < 1e-6) return 0.5;
  const double sinc = x < 1e-9 ? 1 : std::sin(kPi * x) / (kPi * x);
  return std::abs(sinc / (1 - x * x));
}

/// Frequencies of the supported plate, ascending in m, n; at most `most`, drawn evenly.
std::vector<double> plate_frequencies(double l, double w, double stiffness, double highest,
                                      int most, RandomStream& random) {
  std::vector<double> all;
  const double c = kPi / 2 * stiffness;
  for (int m = 1; c * m * m / (l * l) <= highest; ++m) {
    for (int n = 1;; ++n) {
      const double f = c * (m * m / (l * l) + n * n / (w * w));
      if (f > highest) break;
      all.push_back(f);
    }
  }
  if (all.empty()) all.push_back(highest);  // a facet too small to be heard but as a click
  // Selection sampling (Knuth, algorithm S): order is kept.
  std::vector<double> drawn;
  std::size_t left = std::min(all.size(), static_cast<std::size_t>(most));
  for (std::size_t i = 0; i < all.size() && left > 0; ++i) {
    if (random.uniform() * static_cast<double>(all.size() - i) >= static_cast<double>(left))
      continue;
    drawn.push_back(all[i]);
    --left;
  }
  return drawn;
}

/// Adds a damped sine from a sample on.
void ring(const Mode& mode, double eta, int rate, Eigen::Index start, Eigen::VectorXd& out) {
  const double decay = kPi * eta * mode.frequency / rate;
  const auto length = static_cast<Eigen::Index>(-std::log(kSilence) / decay) + 1;
  std::complex<double> z = std::polar(mode.amplitude, mode.phase);
  const std::complex<double> turn = std::polar(std::exp(-decay), 2 * kPi * mode.frequency / rate);
  const Eigen::Index end = std::min(out.size(), start + length);
  for (Eigen::Index i = start; i < end; ++i) {
    out[i] += z.imag();
    z *= turn;
  }
}

/// A raised cosine at the start: the sound sets in as long as the snap takes.
void fade_in(Eigen::VectorXd& out, Eigen::Index start, double seconds, int rate) {
  const auto n = static_cast<Eigen::Index>(seconds * rate);
  for (Eigen::Index i = 0; i < n && start + i < out.size(); ++i) {
    out[start + i] *=
        (1 - std::cos(kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(n))) / 2;
  }
}

/// Of a mode's pressure, relative: a plate far below its coincidence frequency radiates at its
/// edges as f^(1/2) in power; where it is smaller than half a wave of sound, both of its sides
/// cancel each other, and it is a dipole.
double radiated_amplitude(double f, double size) {
  constexpr double kSoundSpeed = 343;  // m/s
  const double waves = 2 * size * f / kSoundSpeed;
  return std::pow(f / 1000, 0.25) * waves * waves / (1 + waves * waves);
}

/// A raised cosine at the end: nothing breaks off.
void fade_out(Eigen::VectorXd& out, int rate) {
  constexpr double kFade = 0.02;  // s
  const Eigen::Index n = std::min(out.size(), static_cast<Eigen::Index>(kFade * rate));
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    out[out.size() - 1 - i] *= (1 - std::cos(kPi * t)) / 2;
  }
}

/// One snap of a plate, of the energy 1.
struct Snap {
  double ruling_length, border, tau;
};

void add_snap(const Snap& snap, double energy, double start, const BankOptions& options,
              double stiffness, int rate, RandomStream& random, Eigen::VectorXd& out) {
  const double width = std::max(snap.border, options.least_ruling);
  const std::vector<double> frequencies = plate_frequencies(
      snap.ruling_length, width, stiffness, options.highest, options.most_modes, random);
  std::vector<Mode> modes;
  double power = 0;
  for (const double f : frequencies) {
    const double excited = pulse_spectrum(f, snap.tau);
    // Equal shares of what the pulse has at f; a mode's energy is its amplitude squared.
    power += excited * excited;
    modes.push_back({f, excited * radiated_amplitude(f, std::max(snap.ruling_length, width)),
                     uniform(random, 0, 2 * kPi)});
  }
  Eigen::VectorXd sound = Eigen::VectorXd::Zero(out.size());
  const auto first = static_cast<Eigen::Index>(start * rate);
  const double gain = std::sqrt(energy / std::max(power, 1e-12) * (snap.border + kLeak));
  for (Mode& mode : modes) {
    mode.amplitude *= gain;
    ring(mode, options.damping, rate, first, sound);
  }
  fade_in(sound, first, snap.tau, rate);
  out += sound;
}

/// Length of a sound of the plate's lowest mode, until it is silent (s).
double ring_time(double ruling_length, double border, double stiffness,
                 const BankOptions& options) {
  const double width = std::max(border, options.least_ruling);
  const double lowest =
      kPi / 2 * stiffness * (1 / (ruling_length * ruling_length) + 1 / (width * width));
  constexpr double kLongest = 0.6;  // s: lower modes than 120 Hz are not heard
  return std::min(kLongest, -std::log(kSilence) / (kPi * options.damping * lowest)) + 0.01;
}

Eigen::VectorXd flap(double ruling_length, double border, const BankOptions& options,
                     double stiffness, int rate, RandomStream& random) {
  const double time = ring_time(ruling_length, border, stiffness, options);
  constexpr double kSpread = 0.06;  // s: over which crackles follow the snap
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>((time + kSpread) * rate));
  add_snap({ruling_length, border, uniform(random, 1e-3, 3e-3)}, 0.7, 0, options, stiffness, rate,
           random, out);
  const int crackles = 3 + static_cast<int>(random.below(6));
  std::vector<double> energy;
  double sum = 0;
  for (int i = 0; i < crackles; ++i) {
    // p(E) ~ E^-1.45 over three decades.
    const double u = random.uniform(), a = -0.45, low = 1, high = 1000;
    energy.push_back(
        std::pow(std::pow(low, a) + u * (std::pow(high, a) - std::pow(low, a)), 1 / a));
    sum += energy.back();
  }
  for (const double e : energy) {
    const double size = uniform(random, 5e-3, 20e-3);
    add_snap({size, std::min(border, size), uniform(random, 5e-5, 2e-4)}, 0.3 * e / sum,
             kSpread * random.uniform(), options, stiffness, rate, random, out);
  }
  fade_out(out, rate);
  return out;
}

Eigen::VectorXd crac(double ruling_length, double border, const BankOptions& options,
                     double stiffness, int rate, RandomStream& random) {
  // A crumpled region rings in facets no longer than its blocked border lets them.
  const double size = std::min(ruling_length, 0.02);
  const double time = ring_time(size, std::min(border, size), stiffness, options);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(time * rate));
  add_snap({size, std::min(border, size), uniform(random, 5e-5, 2e-4)}, 1, 0, options, stiffness,
           rate, random, out);
  return out;
}

/// Noise of a band, by a two-pole filter run twice round: it repeats without a seam.
Eigen::VectorXd friction(double speed, const BankOptions& options, int rate, RandomStream& random) {
  constexpr double kLength = 1.0;  // s
  const auto n = static_cast<Eigen::Index>(kLength * rate);
  const double share =
      std::log(speed / options.least_speed) / std::log(options.most_speed / options.least_speed);
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

/// A few fibres that break.
Eigen::VectorXd tear(const BankOptions& options, double stiffness, int rate, RandomStream& random) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(0.03 * rate));
  const int fibres = 2 + static_cast<int>(random.below(5));
  for (int i = 0; i < fibres; ++i) {
    const double size = uniform(random, 3e-3, 8e-3);
    add_snap({size, size, uniform(random, 3e-5, 1e-4)}, 1.0 / fibres, 8e-3 * random.uniform(),
             options, stiffness, rate, random, out);
  }
  return out;
}

}  // namespace

double pressure_energy(double energy, double free_border) {
  constexpr double kImpedance = 413;       // of air at 20 degrees, rho c (Pa s/m)
  constexpr double kRadiatedShare = 1e-4;  // by a free border of kBorder
  constexpr double kBorder = 0.1;          // m
  const double radiated = kRadiatedShare * (free_border + kLeak) / kBorder * energy;
  return kImpedance / (4 * kPi) * radiated;
}

std::vector<int> SoundBank::of(SoundKind kind) const {
  std::vector<int> all;
  for (std::size_t i = 0; i < sounds.size(); ++i) {
    if (sounds[i].kind == kind) all.push_back(static_cast<int>(i));
  }
  return all;
}

void describe(OptionVisitor& v, BankOptions& o) {
  v.value("sizes", o.sizes, {.doc = "of l_r and of l_c each", .min = 1, .max = 64});
  v.value("variants", o.variants,
          {.doc = "of flaps, and of cracs, for each pair of sizes", .min = 1, .max = 64});
  v.value("least_ruling", o.least_ruling,
          {.doc = "smallest l_r", .unit = "m", .min = 1e-4, .max = 10});
  v.value("most_ruling", o.most_ruling,
          {.doc = "largest l_r", .unit = "m", .min = 1e-4, .max = 10});
  v.value("most_border", o.most_border,
          {.doc = "largest l_c", .unit = "m", .min = 1e-4, .max = 10});
  v.value("speeds", o.speeds, {.doc = "of friction, eight variants each", .min = 1, .max = 64});
  v.value("least_speed", o.least_speed,
          {.doc = "of friction", .unit = "m/s", .min = 1e-6, .max = 100});
  v.value("most_speed", o.most_speed,
          {.doc = "of friction", .unit = "m/s", .min = 1e-6, .max = 100});
  v.value("tears", o.tears, {.doc = "sounds of a step of a tear", .min = 1, .max = 1024});
  v.value("damping", o.damping, {.doc = "loss factor eta of paper", .min = 1e-4, .max = 1});
  v.value("highest", o.highest,
          {.doc = "frequency of a mode", .unit = "Hz", .min = 100, .max = 20000});
  v.value("most_modes", o.most_modes, {.doc = "of a sound", .min = 1, .max = 100000});
}

SoundBank generate_bank(const PaperMaterial& material, const BankOptions& options,
                        std::uint64_t seed) {
  SoundBank bank;
  const double stiffness = std::sqrt(material.bending_stiffness() / material.area_density);
  const std::vector<double> rulings =
      ratios(options.least_ruling, options.most_ruling, options.sizes);
  std::vector<double> borders{0};
  if (options.sizes > 1) {
    const std::vector<double> more =
        ratios(options.least_ruling, options.most_border, options.sizes - 1);
    borders.insert(borders.end(), more.begin(), more.end());
  }
  for (const double l_r : rulings) {
    for (const double l_c : borders) {
      for (const SoundKind kind : {SoundKind::flap, SoundKind::crac}) {
        for (int i = 0; i < options.variants; ++i) bank.sounds.push_back({kind, l_r, l_c});
      }
    }
  }
  constexpr int kVariantsOfFriction = 8;
  for (const double speed : ratios(options.least_speed, options.most_speed, options.speeds)) {
    for (int i = 0; i < kVariantsOfFriction; ++i) {
      bank.sounds.push_back({SoundKind::friction, 0, 0, speed});
    }
  }
  for (int i = 0; i < options.tears; ++i) bank.sounds.push_back({SoundKind::tear});
  parallel_blocks(bank.sounds.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      BankSound& sound = bank.sounds[i];
      RandomStream random(seed, "paper sound bank " + std::to_string(i));
      const int rate = bank.sample_rate;
      const double l_r = sound.ruling_length, l_c = sound.free_border;
      Eigen::VectorXd samples;
      switch (sound.kind) {
        case SoundKind::flap:
          samples = flap(l_r, l_c, options, stiffness, rate, random);
          break;
        case SoundKind::crac:
          samples = crac(l_r, l_c, options, stiffness, rate, random);
          break;
        case SoundKind::friction:
          samples = friction(sound.speed, options, rate, random);
          break;
        case SoundKind::tear:
          samples = tear(options, stiffness, rate, random);
          break;
      }
      if (sound.kind != SoundKind::friction) {
        const double loud = pressure_energy(sound.energy, l_c) * rate;
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
    for (const double x : {sound.ruling_length, sound.free_border, sound.speed, sound.energy}) {
      add_number(x);
    }
    for (const float x : sound.samples) add(std::bit_cast<std::uint32_t>(x));
  }
  return hash;
}

void require_valid(const SoundBank& bank, const std::string& where) {
  for (std::size_t i = 0; i < bank.sounds.size(); ++i) {
    const BankSound& sound = bank.sounds[i];
    const std::string place = where + ": sound " + std::to_string(i);
    if (sound.samples.size() == 0) throw Error("has no samples", place);
    if (!sound.samples.allFinite()) throw Error("has a sample that is not finite", place);
    for (const double x : {sound.ruling_length, sound.free_border, sound.speed}) {
      if (!(x >= 0) || !std::isfinite(x)) {
        throw Error("has the descriptor " + std::to_string(x), place, "0 or more");
      }
    }
  }
  if (bank.of(SoundKind::flap).empty() && bank.of(SoundKind::crac).empty()) {
    throw Error("has no sound of a flap or crac", where, "one at least");
  }
}

}  // namespace geoprior::paper
