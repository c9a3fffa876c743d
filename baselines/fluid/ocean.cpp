#include "baselines/fluid/ocean.h"

#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "baselines/fluid/ocean_transform.h"
#include "core/parallel.h"
#include "core/random.h"

namespace geoprior {
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
    modes.resize(static_cast<std::size_t>(n()) * static_cast<std::size_t>(columns()));
    const auto h0 = [&](int kx, int ky) {
      return factor * std::sqrt(mode_variance(kx, ky)) * random_phase(seed, kx, ky);
    };
    parallel_blocks(static_cast<std::size_t>(n()), kRowBlock, [&](std::size_t b, std::size_t e) {
      for (std::size_t row = b; row < e; ++row) {
        const int ky = ky_of(static_cast<int>(row));
        for (int kx = 0; kx < columns(); ++kx) {
          if (!carries(kx, ky)) continue;
          Mode& mode =
              modes[row * static_cast<std::size_t>(columns()) + static_cast<std::size_t>(kx)];
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
    const auto width = static_cast<std::size_t>(columns());
    parallel_blocks(static_cast<std::size_t>(n()), kRowBlock, [&](std::size_t b, std::size_t e) {
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
        out.col(static_cast<Eigen::Index>(c)) =
            Eigen::Map<const Eigen::VectorXd>(values.get(), count);
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

}  // namespace geoprior
