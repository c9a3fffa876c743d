#include "baselines/fluid/ocean/ocean.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "baselines/fluid/ocean/transform.h"
#include "core/error.h"
#include "core/frame_loop.h"
#include "core/parallel.h"
#include "core/random.h"

namespace geoprior::fluid {
namespace {

using Complex = std::complex<double>;
constexpr std::size_t kRowBlock = 16;

/// One mode and its opposite: what the half of the spectrum with kx >= 0 needs.
struct Mode {
  Complex with;     ///< h0(k): moves along k
  Complex against;  ///< conj(h0(-k)): moves along -k
  double omega = 0;
  double cosine = 0, sine = 0;  ///< direction of k
};

/// SplitMix64 (Steele et al. 2014), its output function: modes get seeds far from each other.
std::uint64_t mixed(std::uint64_t x) {
  x += 0x9E3779B97F4A7C15ULL;
  x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  x = (x ^ (x >> 27U)) * 0x94D049BB133111EBULL;
  return x ^ (x >> 31U);
}

/// (xr + i xi)/2 of a mode, the same for every N.
Complex random_phase(std::uint64_t seed, int kx, int ky) {
  const auto code = [](int k) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(k)); };
  RandomStream random(mixed(mixed(seed) ^ (code(kx) << 32U | code(ky))), "ocean");
  const double real = random.normal();
  const double imaginary = random.normal();
  return Complex(real, imaginary) / 2.0;
}

}  // namespace

struct Ocean::Data {
  OceanOptions options;
  InverseTransform transform;
  std::vector<Mode> modes;  ///< N rows of N/2 + 1
  double variance = 0;      ///< in expectation (m^2)

  Data(const OceanOptions& o, std::uint64_t seed) : options(o), transform(o.samples) {
    sum_variance();
    make_modes(seed);
  }

  [[nodiscard]] int n() const { return options.samples; }
  [[nodiscard]] int columns() const { return n() / 2 + 1; }
  [[nodiscard]] int ky_of(int row) const { return row < n() / 2 ? row : row - n(); }
  [[nodiscard]] double step() const { return 2 * std::numbers::pi / options.size; }
  [[nodiscard]] bool carries(int kx, int ky) const {
    return (kx != 0 || ky != 0) && std::abs(kx) < n() / 2 && std::abs(ky) < n() / 2;
  }
  [[nodiscard]] double mode_variance(int kx, int ky) const {
    return ocean_spectrum(options, step() * Eigen::Vector2d(kx, ky)) * step() * step();
  }

  void sum_variance() {
    const int half = n() / 2;
    for (int ky = 1 - half; ky < half; ++ky) {
      for (int kx = 1 - half; kx < half; ++kx) {
        if (carries(kx, ky)) variance += mode_variance(kx, ky);
      }
    }
  }

  [[nodiscard]] double scale() const {
    if (!options.amplitude) return 1;
    return variance > 0 ? *options.amplitude / (4 * std::sqrt(variance)) : 0;
  }

  void make_modes(std::uint64_t seed) {
    const double factor = scale();
    modes.resize(static_cast<std::size_t>(n()) * columns());
    const auto h0 = [&](int kx, int ky) {
      return factor * std::sqrt(mode_variance(kx, ky)) * random_phase(seed, kx, ky);
    };
    parallel_blocks(n(), kRowBlock, [&](std::size_t b, std::size_t e) {
      for (std::size_t row = b; row < e; ++row) {
        const int ky = ky_of(static_cast<int>(row));
        for (int kx = 0; kx < columns(); ++kx) {
          if (!carries(kx, ky)) continue;
          Mode& mode = modes[row * columns() + static_cast<std::size_t>(kx)];
          const double length = std::hypot(kx, ky);
          mode = {h0(kx, ky), std::conj(h0(-kx, -ky)), ocean_frequency(options, step() * length),
                  kx / length, ky / length};
        }
      }
    });
    variance *= factor * factor;
  }

  /// The field whose coefficients are `coefficient(mode, e^{-i w t})`.
  template <class Coefficient>
  InverseTransform::Field synthesise(double time, const Coefficient& coefficient) const {
    const auto spectrum = transform.coefficients();
    const std::size_t width = columns();
    parallel_blocks(n(), kRowBlock, [&](std::size_t b, std::size_t e) {
      for (std::size_t i = b * width; i < e * width; ++i) {
        spectrum[i] = coefficient(modes[i], std::polar(1.0, -modes[i].omega * time));
      }
    });
    return transform.field(spectrum.get());
  }

  /// Columns dx, dy, h of `field(mode, turn)`, the height's coefficient or its derivative in time.
  template <class Field>
  Eigen::MatrixX3d vectors(double time, const Field& field) const {
    const Eigen::Index count = static_cast<Eigen::Index>(n()) * n();
    const Complex i_lambda(0, options.choppiness);
    Eigen::MatrixX3d out(count, 3);
    parallel_blocks(3, 1, [&](std::size_t b, std::size_t e) {
      for (std::size_t c = b; c < e; ++c) {
        const auto values = synthesise(time, [&](const Mode& mode, const Complex& turn) {
          const Complex height = field(mode, turn);
          return c == 2 ? height : i_lambda * (c == 0 ? mode.cosine : mode.sine) * height;
        });
        out.col(c) = Eigen::Map<const Eigen::VectorXd>(values.get(), count);
      }
    });
    return out;
  }
};

namespace {

Complex height_of(const Mode& mode, const Complex& turn) {
  return mode.with * turn + mode.against * std::conj(turn);
}

Complex rate_of(const Mode& mode, const Complex& turn) {
  return Complex(0, mode.omega) * (mode.against * std::conj(turn) - mode.with * turn);
}

/// Two triangles a square, upwards, diagonals in turn.
Eigen::MatrixX3i grid_triangles(int along) {
  const int cells = along - 1;
  Eigen::MatrixX3i F(2 * static_cast<Eigen::Index>(cells) * cells, 3);
  Eigen::Index t = 0;
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const int a = j * along + i, b = a + 1, c = b + along, d = a + along;
      if ((i + j) % 2 == 0) {
        F.row(t++) << a, b, c;
        F.row(t++) << a, c, d;
      } else {
        F.row(t++) << a, b, d;
        F.row(t++) << b, c, d;
      }
    }
  }
  return F;
}

/// Rows of the samples repeated over all tiles.
Eigen::MatrixX3d tiled(const Eigen::MatrixX3d& samples, int n, int along) {
  Eigen::MatrixX3d out(static_cast<Eigen::Index>(along) * along, 3);
  for (int j = 0; j < along; ++j) {
    for (int i = 0; i < along; ++i) {
      out.row(static_cast<Eigen::Index>(j) * along + i) =
          samples.row(static_cast<Eigen::Index>(j % n) * n + i % n);
    }
  }
  return out;
}

}  // namespace

Ocean::Ocean(const OceanOptions& options, std::uint64_t seed) {
  require_valid(options, "ocean");
  data_ = std::make_unique<Data>(options, seed);
}

Ocean::~Ocean() = default;

Eigen::VectorXd Ocean::heights(double time) const {
  const auto values = data_->synthesise(time, height_of);
  return Eigen::Map<const Eigen::VectorXd>(values.get(),
                                           static_cast<Eigen::Index>(data_->n()) * data_->n());
}

Eigen::MatrixX3d Ocean::displacements(double time) const { return data_->vectors(time, height_of); }

Eigen::MatrixX3d Ocean::velocities(double time) const { return data_->vectors(time, rate_of); }

double Ocean::frequency(int kx, int ky) const {
  return ocean_frequency(data_->options, data_->step() * std::hypot(kx, ky));
}

double Ocean::expected_variance() const { return data_->variance; }

TriMesh Ocean::surface(double time, Eigen::MatrixX3d* velocity) const {
  const OceanOptions& o = data_->options;
  const int n = o.samples, along = n * o.tiles + 1;
  TriMesh mesh{tiled(displacements(time), n, along), grid_triangles(along)};
  const double cell = o.size / n, corner = -o.size * o.tiles / 2;
  for (int j = 0; j < along; ++j) {
    for (int i = 0; i < along; ++i) {
      mesh.V.row(static_cast<Eigen::Index>(j) * along + i) +=
          Eigen::RowVector3d(corner + i * cell, corner + j * cell, o.mean_level);
    }
  }
  if (velocity != nullptr) *velocity = tiled(velocities(time), n, along);
  return mesh;
}

namespace {

constexpr int kMostSamples = 4096;
constexpr int kMostVerticesAlong = 8192;

void require(bool holds, const char* option, double value, const std::string& where,
             const std::string& allowed) {
  if (holds) return;
  throw Error(std::string(option) + " is " + std::to_string(value), where, allowed);
}

}  // namespace

void describe(OptionVisitor& v, OceanOptions& o) {
  static constexpr std::array<std::string_view, 4> kSpectra{"phillips", "pierson-moskowitz",
                                                            "jonswap", "tma"};
  static constexpr std::array<std::string_view, 4> kSpreadings{"none", "cosine-squared",
                                                               "mitsuyasu", "one-sided"};
  describe_choice(v, "spectrum", o.spectrum, kSpectra, {.doc = "spectrum S(omega) of the waves"});
  describe_choice(
      v, "spreading", o.spreading, kSpreadings,
      {.doc = "spreading D(theta): all directions; 2/pi cos^2; cos^2s(theta/2); downwind half"});
  v.value("samples", o.samples,
          {.doc = "samples N along each edge of the patch, a power of two",
           .min = 4,
           .max = kMostSamples});
  v.value("size", o.size, {.doc = "edge L of the patch", .unit = "m", .min = 1e-6, .max = 1e7});
  v.value(
      "wind_speed", o.wind_speed,
      {.doc = "speed U of the wind 10 m above the sea", .unit = "m/s", .min = 1e-3, .max = 200});
  v.value("wind_direction_deg", o.wind_direction_deg,
          {.doc = "direction that the wind blows to, from +x towards +y", .unit = "deg"});
  v.value("fetch", o.fetch,
          {.doc = "distance F over which the wind blows (jonswap, tma)", .unit = "m", .min = 1e-3});
  v.value("peak_enhancement", o.peak_enhancement,
          {.doc = "enhancement gamma of the spectrum's peak (jonswap, tma)", .min = 1, .max = 20});
  v.value("depth", o.depth, {.doc = "depth H of the water", .unit = "m", .min = 1e-6});
  v.value("gravity", o.gravity, {.doc = "acceleration g of gravity", .unit = "m/s^2", .min = 1e-6});
  v.value("choppiness", o.choppiness,
          {.doc = "scale lambda of the horizontal displacement", .min = 0, .max = 10});
  v.value("smallest_wave", o.smallest_wave,
          {.doc = "length s of waves that are damped by 1/e; shorter ones are damped more",
           .unit = "m",
           .min = 0});
  v.value("amplitude", o.amplitude,
          {.doc = "significant wave height to scale to; absent: as the spectrum says",
           .unit = "m",
           .min = 0});
  v.value("mean_level", o.mean_level, {.doc = "level z of the rest surface", .unit = "m"});
  v.value("tiles", o.tiles, {.doc = "patches along x and along y", .min = 1, .max = 64});
}

double vertices_of(const OceanOptions& o) {
  const double along = static_cast<double>(o.samples) * o.tiles + 1;
  return along * along;
}

void require_valid(const OceanOptions& o, const std::string& where) {
  require(o.samples >= 4 && o.samples <= kMostSamples &&
              std::has_single_bit(static_cast<unsigned>(o.samples)),
          "samples", o.samples, where, "a power of two, 4 to " + std::to_string(kMostSamples));
  require(o.tiles >= 1 && o.samples * static_cast<long>(o.tiles) <= kMostVerticesAlong, "tiles",
          o.tiles, where,
          "1 or more, samples * tiles at most " + std::to_string(kMostVerticesAlong));
  const auto positive = [&](const char* option, double value) {
    require(std::isfinite(value) && value > 0, option, value, where, "positive");
  };
  const auto not_negative = [&](const char* option, double value) {
    require(std::isfinite(value) && value >= 0, option, value, where, "0 or more");
  };
  const auto finite = [&](const char* option, double value) {
    require(std::isfinite(value), option, value, where, "finite");
  };
  positive("size", o.size);
  positive("wind_speed", o.wind_speed);
  positive("fetch", o.fetch);
  positive("depth", o.depth);
  positive("gravity", o.gravity);
  not_negative("choppiness", o.choppiness);
  not_negative("smallest_wave", o.smallest_wave);
  if (o.amplitude) not_negative("amplitude", *o.amplitude);
  finite("wind_direction_deg", o.wind_direction_deg);
  finite("mean_level", o.mean_level);
  require(std::isfinite(o.peak_enhancement) && o.peak_enhancement >= 1, "peak_enhancement",
          o.peak_enhancement, where, "1 or more");
}

namespace {

constexpr double kPhillipsAlpha = 8.1e-3;
constexpr double kOnTheJump = 1e-12;

double square(double x) { return x * x; }

/// dw/dk of w^2 = g k tanh(k H).
double group_velocity(double k, double omega, const OceanOptions& o) {
  const double kh = k * o.depth;
  const double t = std::tanh(kh);
  return o.gravity / (2 * omega) * (t + kh * (1 - t * t));
}

/// Peak of a sea that the wind has raised as high as it can: 0.87 g/U of Pierson and Moskowitz, at
/// which 4 beta (w0/w)^4 = 5 puts it.
constexpr double kDevelopedOmega = 0.87;
constexpr double kDevelopedBeta = 1.291;

/// X = g F / U^2.
double dimensionless_fetch(const OceanOptions& o) {
  return o.gravity * o.fetch / square(o.wind_speed);
}

double peak_frequency(const OceanOptions& o) {
  const double scale = o.gravity / o.wind_speed;
  if (o.spectrum == SpectrumKind::jonswap || o.spectrum == SpectrumKind::tma) {
    return 2 * std::numbers::pi * 3.5 * scale * std::pow(dimensionless_fetch(o), -0.33);
  }
  return kDevelopedOmega * std::pow(4 * kDevelopedBeta / 5, 0.25) * scale;
}

/// alpha g^2 / w^5 exp(-beta (w0/w)^4).
double alpha_beta(double omega, double alpha, double beta, double omega0, double g) {
  return alpha * square(g) / std::pow(omega, 5) * std::exp(-beta * square(square(omega0 / omega)));
}

double jonswap(double omega, const OceanOptions& o) {
  const double alpha = 0.076 * std::pow(dimensionless_fetch(o), -0.22);
  const double peak = peak_frequency(o);
  const double sigma = omega <= peak ? 0.07 : 0.09;
  const double bell = std::exp(-square((omega - peak) / (sigma * peak)) / 2);
  return alpha_beta(omega, alpha, 1.25, peak, o.gravity) * std::pow(o.peak_enhancement, bell);
}

/// Kitaigorodskii's factor: the spectrum keeps its shape in k, not in w, when the water gets
/// shallow: (k^-3 dk/dw) over the same in deep water.
double depth_factor(double k, double depth) {
  const double kh = k * depth;
  if (kh > 20) return 1;
  return square(std::tanh(kh)) / (1 + 2 * kh / std::sinh(2 * kh));
}

/// Integral of P over the directions, per k dk: F(k) with m0 = int F(k) k dk.
double omnidirectional(double k, double omega, const OceanOptions& o) {
  if (o.spectrum == SpectrumKind::phillips) {
    const double longest = square(o.wind_speed) / o.gravity;
    return kPhillipsAlpha / 2 * std::exp(-1 / square(k * longest)) / square(square(k));
  }
  double s = 0;
  if (o.spectrum == SpectrumKind::pierson_moskowitz) {
    s = alpha_beta(omega, kPhillipsAlpha, kDevelopedBeta,
                   kDevelopedOmega * o.gravity / o.wind_speed, o.gravity);
  } else {
    s = jonswap(omega, o);
    if (o.spectrum == SpectrumKind::tma) s *= depth_factor(k, o.depth);
  }
  return s * group_velocity(k, omega, o) / k;
}

/// D(theta) = G(s) cos^2s(theta/2), G = Gamma(s + 1) / (2 sqrt(pi) Gamma(s + 1/2)).
double mitsuyasu(double cosine, double omega, const OceanOptions& o) {
  const double peak = peak_frequency(o);
  const double s = 11.5 * std::pow(o.wind_speed * peak / o.gravity, -2.5) *
                   std::pow(omega / peak, omega <= peak ? 5 : -2.5);
  // Stirling's series where the Gamma function would overflow; relative error 4e-8 at s = 50.
  const double ratio =
      s > 50 ? std::sqrt(s + 0.25 + 1 / (32 * s)) : std::tgamma(s + 1) / std::tgamma(s + 0.5);
  return ratio / (2 * std::sqrt(std::numbers::pi)) * std::pow(std::max(0.0, (1 + cosine) / 2), s);
}

/// D(theta), integral 1 over the circle.
double spreading(double cosine, double omega, const OceanOptions& o) {
  switch (o.spreading) {
    case SpreadingKind::none:
      return 1 / (2 * std::numbers::pi);
    case SpreadingKind::cosine_squared:
      return cosine > 0 ? 2 / std::numbers::pi * square(cosine) : 0;
    case SpreadingKind::mitsuyasu:
      return mitsuyasu(cosine, omega, o);
    case SpreadingKind::one_sided:
      // Half of the value on the jump, so that sums over a grid of modes do not lose its column.
      if (std::abs(cosine) < kOnTheJump) return 1 / (2 * std::numbers::pi);
      return cosine > 0 ? 1 / std::numbers::pi : 0;
  }
  return 0;
}

}  // namespace

double ocean_frequency(const OceanOptions& options, double k) {
  return std::sqrt(options.gravity * k * std::tanh(k * options.depth));
}

double ocean_spectrum(const OceanOptions& options, const Eigen::Vector2d& k) {
  const double length = k.norm();
  if (!(length > 0)) return 0;
  const double omega = ocean_frequency(options, length);
  const double angle = options.wind_direction_deg * std::numbers::pi / 180;
  const double cosine =
      std::clamp(k.dot(Eigen::Vector2d(std::cos(angle), std::sin(angle))) / length, -1.0, 1.0);
  const double damping = std::exp(-square(length * options.smallest_wave / (2 * std::numbers::pi)));
  return omnidirectional(length, omega, options) * spreading(cosine, omega, options) * damping;
}

namespace {

double folded_triangles(const TriMesh& mesh) {
  int folded = 0;
  for (Eigen::Index t = 0; t < mesh.F.rows(); ++t) {
    const Eigen::RowVector3d a = mesh.V.row(mesh.F(t, 0));
    const Eigen::RowVector3d u = mesh.V.row(mesh.F(t, 1)) - a, v = mesh.V.row(mesh.F(t, 2)) - a;
    if (!(u.x() * v.y() - u.y() * v.x() > 0)) ++folded;
  }
  return folded;
}

/// Frames of one sea: each follows from its time alone.
class OceanFrames final : public FrameModel {
 public:
  OceanFrames(const OceanOptions& options, const std::vector<double>& times, std::uint64_t seed)
      : options_(options), times_(times), ocean_(options, seed) {}

  [[nodiscard]] int frame_count() const override { return static_cast<int>(times_.size()); }

  void record(int number, FrameSink& sink, RunContext& context) override {
    const double time = times_[number];
    Frame frame;
    frame.parameter = time;
    Eigen::MatrixX3d velocity;
    TriMesh mesh;
    {
      const Phase phase(context, "synthesis");
      mesh = ocean_.surface(time, &velocity);
      frame.parts["samples"] = samples(time);
    }
    frame.diagnostics["folded_triangles"] = folded_triangles(mesh);
    Part& part = frame.parts["surface"];
    part.points = std::move(mesh.V);
    part.triangles = std::move(mesh.F);
    part.arrays.push_back({"velocity", "m/s", NamedArray::On::points, std::move(velocity)});
    frame.tables["sea"] = sea();
    sink.frame(std::move(frame));
  }

 private:
  [[nodiscard]] Part samples(double time) const {
    const double spacing = options_.size / options_.samples;
    Part grid;
    grid.kind = Part::Kind::grid;
    grid.grid_size = {options_.samples, options_.samples, 1};
    grid.grid_origin = {0, 0, options_.mean_level};
    grid.grid_spacing = {spacing, spacing, 1};
    grid.arrays.push_back({"height", "m", NamedArray::On::points, ocean_.heights(time)});
    grid.arrays.push_back({"rate", "m/s", NamedArray::On::points, ocean_.velocities(time).col(2)});
    return grid;
  }

  [[nodiscard]] FrameTable sea() const {
    FrameTable table;
    table.columns = {"depth [m]", "gravity [m/s^2]", "wind_direction [deg]",
                     "expected_variance [m^2]"};
    table.rows.resize(1, 4);
    table.rows << options_.depth, options_.gravity, options_.wind_direction_deg,
        ocean_.expected_variance();
    return table;
  }

  const OceanOptions& options_;
  const std::vector<double>& times_;
  Ocean ocean_;
};

}  // namespace

std::unique_ptr<Process> make_ocean(const OceanOptions& options, std::vector<double> times) {
  require_valid(options, "ocean");
  return frame_process([options, times = std::move(times)](RunContext& context) {
    return std::make_unique<OceanFrames>(options, times, context.seed());
  });
}

}  // namespace geoprior::fluid
