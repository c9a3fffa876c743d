#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <thread>

#include "core/error.h"
#include "core/frame_loop.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/formats/wav_file.h"
#include "testbed/metric_rows.h"
#include "testbed/streams.h"

namespace geoprior::toy {
namespace {

struct PendulumSceneOptions {
  double length_m = 1;
  double damping = 0.2;
  double initial_angle_deg = 5;
  double duration_s = 2;
  int frames = 8;
  int frame_delay_ms = 0;
  int load_delay_ms = 0;
  std::string input;
};

void describe(OptionVisitor& v, PendulumSceneOptions& o) {
  v.value("length_m", o.length_m, {.doc = "length of the rod", .unit = "m", .min = 1e-3});
  v.value("damping", o.damping, {.doc = "decay rate g", .unit = "1/s", .min = 0, .max = 100});
  v.value("initial_angle_deg", o.initial_angle_deg,
          {.doc = "angle at release", .unit = "deg", .min = -20, .max = 20});
  v.value("duration_s", o.duration_s, {.doc = "simulated time", .unit = "s", .min = 1e-6});
  v.value("frames", o.frames, {.doc = "recorded frames after the first", .min = 1, .max = 10000});
  v.value("frame_delay_ms", o.frame_delay_ms,
          {.doc = "waiting time before each frame, to be killed in", .unit = "ms", .min = 0});
  v.value("load_delay_ms", o.load_delay_ms,
          {.doc = "waiting time while loading, to be stopped in", .unit = "ms", .min = 0});
  v.value("input", o.input, {.doc = "frames of another run, which must be there"});
}

struct PendulumOptions {
  double step_s = 0.01;
  bool checkpoints = true;
  int sound_rate_hz = 8000;
  std::optional<double> fail_at_s;
};

void describe(OptionVisitor& v, PendulumOptions& o) {
  v.value("step_s", o.step_s, {.doc = "time step h", .unit = "s", .min = 1e-6, .max = 1});
  v.value("checkpoints", o.checkpoints, {.doc = "save the state after every frame"});
  v.value("sound_rate_hz", o.sound_rate_hz,
          {.doc = "sample rate of swing.wav", .unit = "Hz", .min = kLeastSampleRate, .max = 96000});
  v.value("fail_at_s", o.fail_at_s,
          {.doc = "ends with an error at this time, as a solver that does not converge",
           .unit = "s",
           .min = 0});
}

class PendulumScene final : public Scene {
 public:
  explicit PendulumScene(const PendulumSceneOptions& o) : options(o) {
    if (omega() <= o.damping) {
      throw Error("the pendulum is over-damped", "scene.damping",
                  "less than sqrt(9.81 / length_m) = " + std::to_string(omega()));
    }
  }
  [[nodiscard]] std::vector<double> parameters() const override { return {}; }
  [[nodiscard]] std::string parameter_name() const override { return "time"; }
  [[nodiscard]] std::string parameter_unit() const override { return "s"; }
  [[nodiscard]] std::vector<std::filesystem::path> inputs() const override { return {}; }
  [[nodiscard]] std::map<std::string, double> facts() const override {
    return {{"frequency", omega()}, {"frames", options.frames + 1.0}};
  }
  [[nodiscard]] double omega() const { return std::sqrt(9.81 / options.length_m); }
  [[nodiscard]] double initial_angle() const {
    return options.initial_angle_deg * std::numbers::pi / 180;
  }
  [[nodiscard]] double angle(double t) const {
    return pendulum_angle(initial_angle(), omega(), options.damping, t);
  }
  PendulumSceneOptions options;
};

enum class Scheme { implicit_midpoint, explicit_euler, closed_form };

struct PendulumState {
  double angle = 0;
  double velocity = 0;
  double time = 0;
};

/// Mono, louder samples cut off.
Artifact wav(const std::vector<double>& samples, double full_scale, int rate_hz) {
  Sound sound{rate_hz, Eigen::MatrixXd(samples.size(), 1)};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sound.samples(i, 0) = std::clamp(samples[i] / full_scale, -1.0, 1.0);
  }
  return {"swing.wav", wav_bytes(sound)};
}

class PendulumFrames final : public FrameModel {
 public:
  PendulumFrames(const PendulumScene& scene, const PendulumOptions& options, Scheme scheme)
      : scene_(scene), options_(options), scheme_(scheme), state_{scene.initial_angle(), 0, 0} {}

  [[nodiscard]] int frame_count() const override { return scene_.options.frames + 1; }

  void start(RunContext& /*context*/) override { wait(); }

  void advance(int /*frame*/, FrameSink& sink, RunContext& context) override {
    wait();
    const Phase phase(context, "solve");
    const double interval = scene_.options.duration_s / scene_.options.frames;
    const int steps = std::max(1, static_cast<int>(std::ceil(interval / options_.step_s - 1e-9)));
    const double h = interval / steps;
    const double t0 = state_.time;
    for (int i = 1; i <= steps; ++i) {
      const double before = state_.angle;
      step(state_, h, t0 + i * h);
      state_.time = t0 + i * h;
      samples_.push_back(state_.angle);
      if ((before < 0) != (state_.angle < 0)) sink.event(crossing(state_));
    }
  }

  void record(int number, FrameSink& sink, RunContext& /*context*/) override {
    sink.frame(frame(state_));
    if (number + 1 < frame_count()) return;
    sink.artifact(wav(samples_, std::abs(scene_.initial_angle()) + 1e-12, options_.sound_rate_hz));
  }

  void save(StateWriter& out) const override {
    out.number(state_);
    out.items(samples_);
  }
  void load(StateReader& in, int /*next_frame*/) override {
    state_ = in.number<PendulumState>();
    in.items(samples_);
  }
  [[nodiscard]] bool can_resume() const override { return options_.checkpoints; }

 private:
  void wait() const {
    std::this_thread::sleep_for(std::chrono::milliseconds(scene_.options.frame_delay_ms));
    if (options_.fail_at_s && state_.time >= *options_.fail_at_s) {
      throw Error("does not converge", "time " + std::to_string(state_.time) + " s");
    }
  }

  void step(PendulumState& s, double h, double t) const {
    const double w2 = scene_.omega() * scene_.omega();
    const double g2 = 2 * scene_.options.damping;
    if (scheme_ == Scheme::explicit_euler) {
      const double acceleration = -g2 * s.velocity - w2 * s.angle;
      s.angle += h * s.velocity;
      s.velocity += h * acceleration;
    } else if (scheme_ == Scheme::implicit_midpoint) {
      // v' = v - h (w^2 theta_m + 2 g v_m), theta' = theta + h v_m; v_m = (v + v') / 2,
      // theta_m = theta + h v_m / 2: solved for v_m.
      const double middle =
          (s.velocity - 0.5 * h * w2 * s.angle) / (1 + 0.5 * h * g2 + 0.25 * h * h * w2);
      s.angle += h * middle;
      s.velocity = 2 * middle - s.velocity;
    } else {
      const double previous = s.angle;
      s.angle = scene_.angle(t);
      s.velocity = (s.angle - previous) / h;
    }
  }

  [[nodiscard]] Eigen::Vector3d bob(const PendulumState& s) const {
    const double l = scene_.options.length_m;
    return {l * std::sin(s.angle), -l * std::cos(s.angle), 0};
  }

  [[nodiscard]] Event crossing(const PendulumState& s) const {
    const double speed = scene_.options.length_m * s.velocity;
    return {s.time, "crossing", bob(s), 0.5 * speed * speed, 0, {{"speed_m_s", speed}}};
  }

  [[nodiscard]] Frame frame(const PendulumState& s) const {
    Frame f;
    f.parameter = s.time;
    Part rod;
    rod.kind = Part::Kind::lines;
    rod.points.resize(2, 3);
    rod.points << 0, 0, 0, bob(s).transpose();
    rod.lines = {{0, 1}};
    Part point;
    point.kind = Part::Kind::points;
    point.points = bob(s).transpose();
    point.arrays = {{"speed", "m/s", NamedArray::On::points,
                     Eigen::MatrixXd::Constant(1, 1, scene_.options.length_m * s.velocity)}};
    f.parts = {{"rod", rod}, {"bob", point}, {"warmth", warmth(s)}};
    f.tables["state"] = {{"angle [rad]", "velocity [rad/s]"},
                         Eigen::RowVector2d(s.angle, s.velocity)};
    f.diagnostics["samples"] = static_cast<double>(samples_.size());
    return f;
  }

  /// A Gaussian about the bob on a 9 x 5 x 1 grid.
  [[nodiscard]] Part warmth(const PendulumState& s) const {
    Part grid;
    grid.kind = Part::Kind::grid;
    grid.grid_size = {9, 5, 1};
    const double l = scene_.options.length_m;
    grid.grid_origin = {-l, -1.5 * l, 0};
    grid.grid_spacing = {l / 4, l / 4, l};
    Eigen::MatrixXd values(45, 1);
    for (int j = 0; j < 5; ++j) {
      for (int i = 0; i < 9; ++i) {
        const Eigen::Vector3d x =
            grid.grid_origin + grid.grid_spacing.cwiseProduct(Eigen::Vector3d(i, j, 0));
        values(9 * j + i, 0) = std::exp(-(x - bob(s)).squaredNorm() / (l * l));
      }
    }
    grid.arrays = {{"warmth", "1", NamedArray::On::points, values}};
    return grid;
  }

  const PendulumScene& scene_;
  const PendulumOptions& options_;
  Scheme scheme_;
  PendulumState state_;
  std::vector<double> samples_;  ///< of the sound so far
};

MethodEntry pendulum_method(std::string name, bool is_baseline, std::string summary,
                            Scheme scheme) {
  return method_entry<PendulumScene, PendulumOptions>(
      std::move(name), is_baseline, std::move(summary), "Hairer, Lubich, Wanner 2006",
      [scheme](const PendulumScene& scene, const PendulumOptions& options, RunContext&) {
        return frame_process([&scene, options, scheme](RunContext&) {
          return std::make_unique<PendulumFrames>(scene, options, scheme);
        });
      });
}

double angle_of(const Frame& frame) {
  const Eigen::RowVector3d p = frame.require_part("bob").points.row(0);
  return std::atan2(p.x(), -p.y());
}

double angle_error(const PendulumScene& scene, const Frame& frame) {
  return std::abs(angle_of(frame) - scene.angle(frame.parameter));
}

double largest_angle_error(const PendulumScene& scene, const FrameSequence& frames) {
  double largest = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    largest = std::max(largest, angle_error(scene, *frames.frame(i)));
  }
  return largest;
}

double distance_of_bobs(const PendulumScene&, const Frame& frame, const Frame& reference) {
  return (frame.require_part("bob").points.row(0) - reference.require_part("bob").points.row(0))
      .norm();
}

std::vector<MetricGroup> pendulum_metrics() {
  constexpr Direction kLow = Direction::lower_is_better;
  constexpr Tolerance kSmooth{1e-12, 1e-6};
  return {
      frame_metrics<PendulumScene>(angle_error)
          .row("angle_error", "rad", "distance of the angle to the closed form", kLow, kSmooth),
      sequence_metrics<PendulumScene>(largest_angle_error)
          .row("largest_angle_error", "rad", "largest angle_error over the frames", kLow, kSmooth),
      reference_metrics<PendulumScene>({"bob"}, distance_of_bobs)
          .row("distance_to_reference", "m", "distance of the bob to that of the reference", kLow,
               kSmooth)};
}

}  // namespace

double pendulum_angle(double initial_angle, double frequency, double damping, double time_s) {
  const double wd = std::sqrt(frequency * frequency - damping * damping);
  return initial_angle * std::exp(-damping * time_s) *
         (std::cos(wd * time_s) + damping / wd * std::sin(wd * time_s));
}

Topic pendulum_topic() {
  Topic topic;
  topic.name = "toy-pendulum";
  topic.summary = "processes: a damped pendulum with a closed form";
  topic.default_scene = [] { return std::make_unique<TypedOptions<PendulumSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path&,
                  std::uint64_t) -> std::shared_ptr<Scene> {
    const auto& options = dynamic_cast<const TypedOptions<PendulumSceneOptions>&>(set).options;
    if (options.load_delay_ms > 0) say("loading");  // the time to stop it in has begun
    std::this_thread::sleep_for(std::chrono::milliseconds(options.load_delay_ms));
    if (!options.input.empty() && !std::filesystem::is_directory(options.input)) {
      throw Error("is no folder of frames: " + options.input, "scene.input");
    }
    return std::make_shared<PendulumScene>(options);
  };
  topic.methods = {
      pendulum_method("implicit-midpoint", false, "second order, symplectic without damping",
                      Scheme::implicit_midpoint),
      pendulum_method("closed-form", false, "the exact solution", Scheme::closed_form),
      pendulum_method("explicit-euler", true, "first order, gains energy", Scheme::explicit_euler)};
  topic.metrics = pendulum_metrics();
  DiagnosticTable diagnostics;
  diagnostics.unmeasured("of a sound that is recorded when it is whole",
                         {{"samples", "1", "of the sound so far"}});
  topic.diagnostics = diagnostics.rows();
  topic.view.part = "rod";
  return topic;
}

}  // namespace geoprior::toy
