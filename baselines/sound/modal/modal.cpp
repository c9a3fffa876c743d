#include "baselines/sound/modal/modal.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "models/sound/voices/air.h"
#include "models/sound/voices/ring.h"

namespace geoprior::sound {
namespace {

/// tau (s), in the middle of what the generated bank has: the comparison says nothing of it.
constexpr double kFlapTime = 1.7e-3, kCracTime = 1e-4;
/// Over which a mode's pressure is averaged: a spiral of Fibonacci, 0.26 sr each.
constexpr int kDirections = 48;

using Eigen::Vector3d;

using std::numbers::pi;
constexpr int kRate = 48000;      // of voices (Hz)
constexpr double kLongest = 0.6;  // s, as of the generated bank

/// Points of the unit sphere, evenly spread.
std::vector<Vector3d> sphere(int count) {
  std::vector<Vector3d> all;
  const double turn = pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
    all.emplace_back(r * std::cos(turn * i), r * std::sin(turn * i), z);
  }
  return all;
}

/// Normals of the vertices times the area that each stands for (m^2).
Eigen::MatrixX3d vertex_areas(const ShellState& state) {
  Eigen::MatrixX3d areas = Eigen::MatrixX3d::Zero(state.x.rows(), 3);
  for (int t = 0; t < state.mesh.triangle_count(); ++t) {
    const Eigen::Vector3i v = state.mesh.triangles.row(t);
    const Vector3d p = state.x.row(v[0]), q = state.x.row(v[1]), r = state.x.row(v[2]);
    const Vector3d area = (q - p).cross(r - p) / 2;
    for (const int corner : v) areas.row(corner) += area.transpose() / 3;
  }
  return areas;
}

/// Integral of |grad w|^2 over that of w^2, w by vertices, linear on the triangles (1/m^2).
double wave_square(const ShellState& state, const Eigen::VectorXd& w) {
  double slopes = 0, squares = 0;
  for (int t = 0; t < state.mesh.triangle_count(); ++t) {
    const Eigen::RowVector3i v = state.mesh.triangles.row(t);
    Eigen::Matrix2d edges;
    edges << state.mesh.pattern.row(v[1]) - state.mesh.pattern.row(v[0]),
        state.mesh.pattern.row(v[2]) - state.mesh.pattern.row(v[0]);
    const double area = pattern_area(state.mesh, t), a = w[v[0]], b = w[v[1]], c = w[v[2]];
    slopes += area * (edges.inverse() * Eigen::Vector2d(b - a, c - a)).squaredNorm();
    squares += area * (a * a + b * b + c * c + a * b + b * c + c * a) / 6;
  }
  return squares > 0 ? slopes / squares : 0;
}

/// The modes of a resonator and how loud each is after the event.
struct StruckModes {
  Eigen::VectorXd frequency;  ///< Hz
  Eigen::VectorXd pressure;   ///< amplitude at 1 m (Pa)
  double resolved = 0;        ///< Hz
};

StruckModes strike(const ModalSoundOptions& options, const PaperMaterial& material,
                   const SoundEvent& event, const ResonatorShape& shape) {
  const auto cells = static_cast<double>(shape.cells.size());
  constexpr int kFinest = 8;
  const int subdivision =
      std::clamp(static_cast<int>(std::sqrt(options.most_vertices / cells)), 1, kFinest);
  const ResonatorMesh piece = mesh_of(shape, subdivision);
  const ModalSupports supports{piece.clamped, {}};
  StruckModes out;
  out.resolved = std::min(resolved_frequency(material, piece.state.mesh), options.highest);
  const Modes modes =
      eigenmodes(material, piece.state, supports, {options.most_modes, out.resolved, {}});
  const Eigen::Index count = modes.frequency.size();
  if (count == 0) return out;
  if (count == options.most_modes) out.resolved = modes.frequency[count - 1];
  const ModalOperator shell(material, piece.state, supports, {});
  const Eigen::VectorXd force = modes.shape.transpose() * shell.curvature_load(piece.change);
  const Eigen::ArrayXd omega = 2 * pi * modes.frequency.array();
  const double tau = event.kind == SoundKind::crac ? kCracTime : kFlapTime;
  Eigen::ArrayXd coordinate = force.array().abs() / omega.square();
  for (Eigen::Index m = 0; m < count; ++m) coordinate[m] *= pulse_spectrum(modes.frequency[m], tau);
  const double energy = (omega * coordinate).square().sum() / 2;
  if (!(energy > 0)) return out;
  coordinate *= std::sqrt(event.energy / energy);
  out.frequency = modes.frequency;
  out.pressure = coordinate * radiated_pressure(piece.state, modes, kDirections).array();
  return out;
}

class ModalVoices final : public SoundVoices {
 public:
  ModalVoices(const ModalSoundOptions& options, const PaperMaterial& material)
      : options_(options), material_(material) {}

  [[nodiscard]] bool needs_shapes() const override { return true; }

  [[nodiscard]] EventVoice voice(const SoundEvent& event, const ResonatorShape& shape,
                                 RandomStream random) const override {
    EventVoice made;
    made.voice.time = event.time;
    made.voice.position = event.position;
    if (shape.cells.empty()) return made;
    const StruckModes modes = strike(options_, material_, event, shape);
    const Eigen::Index count = modes.frequency.size();
    made.numbers = {{"modes", static_cast<double>(count)},
                    {"resolved_hz", modes.resolved},
                    {"radiated_share", 0.0}};
    if (count == 0) return made;
    made.numbers["lowest_hz"] = modes.frequency[0];
    // p^2 / (rho c) over the sphere of 1 m, and over time.
    const double radiated =
        4 * pi / (kAirDensity * kSoundSpeed) *
        (modes.pressure.array().square() / (4 * pi * options_.damping * modes.frequency.array()))
            .sum();
    made.numbers["radiated_share"] = radiated / event.energy;
    const double tau = event.kind == SoundKind::crac ? kCracTime : kFlapTime;
    const double length =
        std::min(kLongest, ringing_time(modes.frequency[0], options_.damping)) + tau + 0.02;
    Eigen::VectorXd samples = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(length * kRate));
    for (Eigen::Index m = 0; m < count; ++m) {
      add_ringing({modes.frequency[m], modes.pressure[m], 2 * pi * random.uniform()},
                  options_.damping, kRate, 0, samples);
    }
    fade_in(samples, 0, tau, kRate);
    fade_out(samples, kRate);
    made.own = std::make_shared<const Eigen::VectorXf>(samples.cast<float>());
    made.voice.samples = {made.own->data(), static_cast<std::size_t>(made.own->size())};
    made.voice.rate = kRate;
    return made;
  }

 private:
  ModalSoundOptions options_;
  PaperMaterial material_;
};

}  // namespace

Eigen::VectorXd radiated_pressure(const ShellState& state, const Modes& modes, int directions) {
  const Eigen::MatrixX3d areas = vertex_areas(state);
  const Eigen::MatrixX3d normals = areas.rowwise().normalized();
  const std::vector<Vector3d> sky = sphere(directions);
  const Eigen::RowVector3d middle = state.x.colwise().mean();
  Eigen::MatrixXd along(state.x.rows(), directions), facing(state.x.rows(), directions);
  for (int d = 0; d < directions; ++d) {
    along.col(d) = (state.x.rowwise() - middle) * sky[d];
    facing.col(d) = areas * sky[d];
  }
  const double area = areas.rowwise().norm().sum();
  Eigen::VectorXd pressure(modes.frequency.size());
  for (Eigen::Index m = 0; m < pressure.size(); ++m) {
    const double omega = 2 * pi * modes.frequency[m], k = omega / kSoundSpeed;
    Eigen::VectorXd w(state.x.rows());
    for (Eigen::Index v = 0; v < w.size(); ++v)
      w[v] = normals.row(v).dot(modes.shape.col(m).segment<3>(3 * v));
    const double jump = pressure_jump(omega, wave_square(state, w), area);
    double squares = 0;
    for (int d = 0; d < directions; ++d) {
      const Eigen::ArrayXd source = jump * w.array() * facing.col(d).array();
      const Eigen::ArrayXd phase = k * along.col(d).array();
      squares +=
          std::pow((source * phase.cos()).sum(), 2) + std::pow((source * phase.sin()).sum(), 2);
    }
    pressure[m] = k / (4 * pi) * std::sqrt(squares / directions);
  }
  return pressure;
}

void describe(OptionVisitor& v, ModalSoundOptions& o) {
  describe(v, o.stage);
  v.value("damping", o.damping,
          {.doc = "loss factor eta of the paper that rings", .min = 1e-4, .max = 1});
  v.value("highest", o.highest,
          {.doc = "highest frequency of a mode", .unit = "Hz", .min = 100, .max = 20000});
  v.value("most_modes", o.most_modes, {.doc = "most modes of a resonator", .min = 1, .max = 10000});
  v.value("most_vertices", o.most_vertices,
          {.doc = "most vertices of a resonator's mesh, unless it has more cells",
           .min = 16,
           .max = 1000000});
}

std::shared_ptr<const SoundVoices> modal_voices(const ModalSoundOptions& options,
                                                const PaperMaterial& material) {
  return std::make_shared<ModalVoices>(options, material);
}

}  // namespace geoprior::sound
