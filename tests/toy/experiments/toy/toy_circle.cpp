#include <cmath>
#include <memory>
#include <numbers>

#include "core/angles.h"
#include "core/error.h"
#include "experiments/toy/toy_topic.h"
#include "testbed/metric_rows.h"

namespace geoprior::toy {
namespace {

struct CircleSceneOptions {
  double radius_m = 1;
  int points = 24;
  bool suggests_camera = false;
  struct Motion {
    double from_deg = 0;
    double to_deg = 90;
    int frames = 4;
  } motion;
};

void describe(OptionVisitor& v, CircleSceneOptions::Motion& o) {
  v.value("from_deg", o.from_deg, {.doc = "first angle", .unit = "deg"});
  v.value("to_deg", o.to_deg, {.doc = "last angle", .unit = "deg"});
  v.value("frames", o.frames, {.doc = "number of angles", .min = 1, .max = 1000});
}

void describe(OptionVisitor& v, CircleSceneOptions& o) {
  v.value("radius_m", o.radius_m, {.doc = "radius r", .unit = "m", .min = 1e-6, .max = 1e6});
  v.value("points", o.points, {.doc = "points on the rim", .min = 3, .max = 1000000});
  v.value("suggests_camera", o.suggests_camera, {.doc = "a camera at the right of the rim"});
  describe_group(v, "motion", o.motion, {.doc = "angles at which the disc is posed"});
}

struct ExactOptions {};
void describe(OptionVisitor&, ExactOptions&) {}

enum class Corner { on_rim, outside };
constexpr std::array<std::string_view, 2> kCornerNames{"on-rim", "outside"};

struct PolygonOptions {
  int segments = 16;
  Corner corner = Corner::on_rim;
  double scale = 1;
};

void describe(OptionVisitor& v, PolygonOptions& o) {
  v.value("segments", o.segments, {.doc = "corners of the polygon n", .min = 3, .max = 100000});
  describe_choice(v, "corner", o.corner, kCornerNames,
                  {.doc = "corners on the rim, or edges that touch it"});
  v.value("scale", o.scale, {.doc = "factor on the radius", .min = 0.5, .max = 2});
}

struct GreetingOptions {
  std::string words = "hello";
  int times_said = 1;
};

void describe(OptionVisitor& v, GreetingOptions& o) {
  v.value("words", o.words, {.doc = "what is said"});
  v.value("times_said", o.times_said, {.doc = "how often", .min = 1, .max = 3});
}

/// A command of a topic: says something to its argument.
CommandText greet(const std::string& name, const GreetingOptions& options) {
  CommandText result;
  for (int i = 0; i < options.times_said; ++i) result.text += options.words + " " + name + "\n";
  if (options.times_said > 1) result.notices.emplace_back("said more than once");
  return result;
}

class CircleScene final : public Scene {
 public:
  explicit CircleScene(const CircleSceneOptions& o) : options(o) {}
  [[nodiscard]] std::vector<double> parameters() const override {
    const auto& m = options.motion;
    std::vector<double> angles;
    for (int i = 0; i < m.frames; ++i) {
      angles.push_back(m.frames == 1 ? m.to_deg
                                     : m.from_deg + (m.to_deg - m.from_deg) * i / (m.frames - 1));
    }
    return angles;
  }
  [[nodiscard]] std::string parameter_name() const override { return "angle"; }
  [[nodiscard]] std::string parameter_unit() const override { return "deg"; }
  [[nodiscard]] std::vector<std::filesystem::path> inputs() const override { return {}; }
  [[nodiscard]] std::map<std::string, double> facts() const override {
    return {{"vertices", options.points + 1.0}};
  }
  [[nodiscard]] std::optional<Camera> camera() const override {
    if (!options.suggests_camera) return std::nullopt;
    return Camera{{options.radius_m, 0, 0}, {0, 0, 1}, {0, 1, 0}, options.radius_m};
  }
  CircleSceneOptions options;
};

/// The disc as a fan about its centre; `radius_at(phi)` is the method's radius in direction phi
/// (rad).
class CircleMethod final : public PoseMethod {
 public:
  CircleMethod(const CircleScene& scene, std::function<double(double)> radius_at)
      : points_(scene.options.points),
        radius_at_(std::move(radius_at)),
        V_(Eigen::MatrixX3d::Zero(points_ + 1, 3)),
        F_(points_, 3) {
    for (int i = 0; i < points_; ++i) F_.row(i) << 0, 1 + i, 1 + (i + 1) % points_;
  }

  void solve(double parameter, RunContext& context) override {
    Phase phase(context, "rim");
    parameter_ = parameter;
    for (int i = 0; i < points_; ++i) {
      const double phi = parameter * kDegree + 2 * std::numbers::pi * i / points_;
      const double r = radius_at_(phi);
      V_.row(1 + i) << r * std::cos(phi), r * std::sin(phi), 0;
    }
  }

  [[nodiscard]] Frame frame() const override {
    Frame f;
    f.parameter = parameter_;
    Part surface;
    surface.points = V_;
    surface.triangles = F_;
    surface.arrays = {{"radius", "m", NamedArray::On::points, V_.rowwise().norm()}};
    f.parts["surface"] = surface;
    f.diagnostics["evaluations"] = points_;
    return f;
  }

 private:
  int points_;
  std::function<double(double)> radius_at_;
  Eigen::MatrixX3d V_;
  Eigen::MatrixX3i F_;
  double parameter_ = 0;
};

double polygon_radius(double r, const PolygonOptions& o, double phi) {
  const double sector = 2 * std::numbers::pi / o.segments;
  const double inside = phi - sector * std::floor(phi / sector) - sector / 2;
  const double apothem = o.corner == Corner::on_rim ? std::cos(sector / 2) : 1;
  return o.scale * r * apothem / std::cos(inside);
}

/// Largest distance of a rim point to the circle (m).
double radius_error(const CircleScene& scene, const Frame& frame) {
  const auto& V = frame.require_part("surface").points;
  return (V.bottomRows(V.rows() - 1).rowwise().norm().array() - scene.options.radius_m)
      .abs()
      .maxCoeff();
}

double largest_radius_error(const CircleScene& scene, const FrameSequence& frames) {
  double largest = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    largest = std::max(largest, radius_error(scene, *frames.frame(i)));
  }
  return largest;
}

double largest_distance(const CircleScene&, const Frame& frame, const Frame& reference) {
  return (frame.require_part("surface").points - reference.require_part("surface").points)
      .rowwise()
      .norm()
      .maxCoeff();
}

std::vector<MetricGroup> circle_metrics() {
  constexpr Direction kLow = Direction::lower_is_better;
  constexpr Tolerance kSmooth{1e-12, 1e-6};
  return {
      frame_metrics<CircleScene>(radius_error)
          .row("radius_error", "m", "largest distance of a rim point to the circle", kLow, kSmooth),
      sequence_metrics<CircleScene>(largest_radius_error)
          .row("largest_radius_error", "m", "largest radius_error over the frames", kLow, kSmooth),
      reference_metrics<CircleScene>({}, largest_distance)
          .row("distance_to_reference", "m", "largest distance of corresponding points", kLow,
               kSmooth)};
}

std::vector<MethodEntry> circle_methods() {
  return {method_entry<CircleScene, ExactOptions>(
              "exact", false, "points on the circle", "Euclid, book III",
              [](const CircleScene& scene, const ExactOptions&, RunContext&) {
                const double r = scene.options.radius_m;
                return std::make_unique<CircleMethod>(scene, [r](double) { return r; });
              }),
          method_entry<CircleScene, PolygonOptions>(
              "polygon", true, "points on a regular polygon", "Archimedes",
              [](const CircleScene& scene, const PolygonOptions& options, RunContext&) {
                if (options.segments > 1000 * scene.options.points) {
                  throw NotApplicable(std::to_string(options.segments) + " corners", "disc",
                                      "1000 a point");
                }
                const double r = scene.options.radius_m;
                return std::make_unique<CircleMethod>(
                    scene, [r, options](double phi) { return polygon_radius(r, options, phi); });
              })};
}

}  // namespace

Topic circle_topic() {
  Topic topic;
  topic.name = "toy-circle";
  topic.summary = "pose methods: a disc that turns";
  topic.default_scene = [] { return std::make_unique<TypedOptions<CircleSceneOptions>>(); };
  topic.load = [](const OptionSet& set, const std::filesystem::path&,
                  std::uint64_t) -> std::shared_ptr<Scene> {
    return std::make_shared<CircleScene>(
        dynamic_cast<const TypedOptions<CircleSceneOptions>&>(set).options);
  };
  topic.last_parameter = [](const OptionSet& set) {
    const auto& motion = dynamic_cast<const TypedOptions<CircleSceneOptions>&>(set).options.motion;
    return LastParameter{motion.to_deg, "deg"};
  };
  topic.methods = circle_methods();
  topic.metrics = circle_metrics();
  DiagnosticTable diagnostics;
  diagnostics.unmeasured("work of the method, which leaves no trace in the rim",
                         {{"evaluations", "1", "points of the rim", true, {0.5, 0}}});
  topic.diagnostics = diagnostics.rows();
  topic.commands = {topic_command<GreetingOptions>("greet", "say something to somebody", "name",
                                                   "who is meant", greet)};
  topic.commands.front().second_argument = "words";
  topic.files = {
      {"rim", "points of a rim", "[rim]", {{"angle", "number", "", "", "deg", "where"}}}};
  return topic;
}

std::vector<Topic> topics() { return {pendulum_topic(), circle_topic()}; }

}  // namespace geoprior::toy
