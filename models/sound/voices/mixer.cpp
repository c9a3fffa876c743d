#include "models/sound/voices/mixer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "core/error.h"
#include "models/sound/voices/air.h"

namespace geoprior::sound {
namespace {

using Eigen::Vector3d;

constexpr double kNearest = 0.05;  // m

Vector3d to_vector(const std::array<double, 3>& x) { return {x[0], x[1], x[2]}; }

/// The cubic through four samples at `t` of the way from the second to the third.
inline double cubic(const float* from, double t) {
  const double a = from[0], b = from[1], c = from[2], d = from[3];
  return -t * (t - 1) * (t - 2) / 6 * a + (t + 1) * (t - 1) * (t - 2) / 2 * b -
         (t + 1) * t * (t - 2) / 2 * c + (t + 1) * t * (t - 1) / 6 * d;
}

/// A sample between two, by the cubic through four; 0 before the first and after the last, unless
/// the samples repeat.
double sample_at(std::span<const float> samples, double at, bool repeats) {
  const std::ptrdiff_t n = samples.size();
  const double floor = std::floor(at);
  const double t = at - floor;
  const auto first = static_cast<std::ptrdiff_t>(floor);
  const auto value = [&](std::ptrdiff_t i) -> float {
    if (repeats) i = ((i % n) + n) % n;
    return i < 0 || i >= n ? 0.0F : samples[i];
  };
  const std::array<float, 4> four{value(first - 1), value(first), value(first + 1),
                                  value(first + 2)};
  return cubic(four.data(), t);
}

/// Adds a voice that sounds once. In the middle of its samples no end of them has to be thought of.
void add_once(const Voice& voice, double start, double gain, int rate,
              Eigen::Ref<Eigen::VectorXd> out) {
  const std::ptrdiff_t count = voice.samples.size();
  const double length = static_cast<double>(count + 2) / voice.rate;
  const auto first = std::max<Eigen::Index>(0, static_cast<Eigen::Index>(std::ceil(start * rate)));
  const auto end = std::min<Eigen::Index>(
      out.size(), static_cast<Eigen::Index>(std::ceil((start + length) * rate)));
  for (Eigen::Index i = first; i < end; ++i) {
    const double at = (static_cast<double>(i) / rate - start) * voice.rate;
    const auto floor = static_cast<std::ptrdiff_t>(at);  // not negative
    const bool within = floor >= 1 && floor + 2 < count;
    out[i] +=
        gain * (within ? cubic(voice.samples.data() + floor - 1, at - static_cast<double>(floor))
                       : sample_at(voice.samples, at, false));
  }
}

/// Adds one voice as an ear hears it that it reaches after `delay` (s).
void add(const Voice& voice, double delay, double gain, int rate, Eigen::Ref<Eigen::VectorXd> out) {
  if (voice.samples.empty()) return;
  if (voice.envelope.empty()) {
    add_once(voice, voice.time + delay, gain, rate, out);
    return;
  }
  const double start = voice.envelope.front().x() + delay;
  const double length = voice.envelope.back().x() - voice.envelope.front().x();
  const auto first = std::max<Eigen::Index>(0, static_cast<Eigen::Index>(std::ceil(start * rate)));
  const auto end = std::min<Eigen::Index>(
      out.size(), static_cast<Eigen::Index>(std::ceil((start + length) * rate)));
  std::size_t key = 0;
  for (Eigen::Index i = first; i < end; ++i) {
    const double since = static_cast<double>(i) / rate - start;
    const double now = voice.envelope.front().x() + since;
    while (key + 2 < voice.envelope.size() && voice.envelope[key + 1].x() <= now) ++key;
    const Eigen::Vector2d &a = voice.envelope[key],
                          &b = voice.envelope[std::min(key + 1, voice.envelope.size() - 1)];
    const double share = b.x() > a.x() ? std::clamp((now - a.x()) / (b.x() - a.x()), 0.0, 1.0) : 0;
    const double loud = gain * (a.y() + share * (b.y() - a.y()));
    out[i] += loud * sample_at(voice.samples, since * voice.rate, true);
  }
}

/// Largest modulus of the signal 8 times oversampled, by a windowed sinc of 48 samples.
double true_peak(const Eigen::Ref<const Eigen::VectorXd>& x) {
  constexpr int kHalf = 24, kPhases = 8;
  static const auto kernel = [] {
    Eigen::Matrix<double, kPhases, 2 * kHalf> taps;
    for (int p = 0; p < kPhases; ++p) {
      for (int k = 0; k < 2 * kHalf; ++k) {
        const double t = k - (kHalf - 1) - p / static_cast<double>(kPhases);
        const double window = 0.5 + 0.5 * std::cos(std::numbers::pi * t / kHalf);
        const double angle = std::numbers::pi * t;
        taps(p, k) = std::abs(t) < 1e-12 ? 1 : window * std::sin(angle) / angle;
      }
    }
    return taps;
  }();
  const double sample_peak = x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0;
  if (sample_peak == 0) return 0;
  double peak = sample_peak;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    // Where nothing near is loud, nothing between is louder than the loudest sample.
    const Eigen::Index low = std::max<Eigen::Index>(0, i - kHalf + 1);
    const Eigen::Index high = std::min<Eigen::Index>(x.size(), i + kHalf + 1);
    if (std::abs(x[i]) < sample_peak / 4) continue;
    for (int p = 1; p < kPhases; ++p) {
      double sum = 0;
      for (Eigen::Index j = low; j < high; ++j) sum += kernel(p, j - i + kHalf - 1) * x[j];
      peak = std::max(peak, std::abs(sum));
    }
  }
  return peak;
}

}  // namespace

void describe(OptionVisitor& v, MixOptions& o) {
  v.value("sample_rate", o.sample_rate,
          {.doc = "samples of the sound file in a second: 44100 or 48000",
           .unit = "Hz",
           .min = 44100,
           .max = 48000});
  v.value("stereo", o.stereo, {.doc = "whether two ears hear the sheet, or one between them"});
  v.value("listener", o.listener, {.doc = "middle of the listener's ears", .unit = "m"});
  v.value("right", o.right, {.doc = "direction from the left ear to the right one"});
  v.value("ears", o.ears,
          {.doc = "distance of the listener's ears", .unit = "m", .min = 0, .max = 10});
  v.value("wall", o.wall, {.doc = "whether a wall or a table throws sound back"});
  v.value("wall_point", o.wall_point, {.doc = "a point of the wall", .unit = "m"});
  v.value("wall_normal", o.wall_normal, {.doc = "normal of the wall, of any length"});
  v.value("reflection", o.reflection,
          {.doc = "share of the pressure that the wall throws back", .min = -1, .max = 1});
  v.value("full_scale", o.full_scale,
          {.doc = "pressure that the largest sample stands for", .unit = "Pa", .min = 1e-9});
  v.value(
      "highest_peak", o.highest_peak,
      {.doc = "true peak that the whole sound stays under", .unit = "dBFS", .min = -120, .max = 0});
}

Eigen::VectorXd heard_alone(const Voice& voice, int sample_rate) {
  const auto n = static_cast<double>(voice.samples.size());
  Eigen::VectorXd out =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(std::ceil(n / voice.rate * sample_rate)));
  Voice once = voice;
  once.envelope.clear();
  once.time = 0;
  add(once, 0, voice.gain, sample_rate, out);
  return out;
}

Mix mix(const std::vector<Voice>& voices, double duration, const MixOptions& options) {
  const int rate = options.sample_rate;
  if (rate != 44100 && rate != 48000) {
    throw Error("is " + std::to_string(rate), "sample_rate", "44100 or 48000");
  }
  const Vector3d listener = to_vector(options.listener), right = to_vector(options.right);
  const Vector3d across = to_vector(options.wall_normal), wall = to_vector(options.wall_point);
  if (options.wall && !(across.norm() > 0)) throw Error("has no direction", "wall_normal");
  if (options.stereo && !(right.norm() > 0)) throw Error("has no direction", "right");
  std::vector<Vector3d> ears{listener};
  if (options.stereo) {
    const Vector3d half = options.ears / 2 * right.normalized();
    ears = {listener - half, listener + half};
  }
  Mix result;
  result.samples =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(std::ceil(duration * rate)), ears.size());
  for (std::size_t ear = 0; ear < ears.size(); ++ear) {
    auto channel = result.samples.col(ear);
    for (const Voice& voice : voices) {
      const auto hear = [&](const Vector3d& from, double share) {
        const double distance = (from - ears[ear]).norm();
        add(voice, distance / kSoundSpeed,
            share * voice.gain / options.full_scale / std::max(distance, kNearest), rate, channel);
      };
      hear(voice.position, 1);
      if (!options.wall) continue;
      const Vector3d n = across.normalized();
      hear(voice.position - 2 * n.dot(voice.position - wall) * n, options.reflection);
    }
  }
  double peak = 0;
  for (Eigen::Index c = 0; c < result.samples.cols(); ++c) {
    peak = std::max(peak, true_peak(result.samples.col(c)));
  }
  const double limit = std::pow(10, options.highest_peak / 20);
  if (peak > limit) {
    result.lowered = 20 * std::log10(peak / limit);
    result.samples *= limit / peak;
    peak = limit;
  }
  result.true_peak = peak > 0 ? 20 * std::log10(peak) : -std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace geoprior::sound
