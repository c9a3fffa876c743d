#include "experiments/sketch/truth/synthetic_layers.h"

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "core/angles.h"
#include "core/error.h"
#include "core/random.h"

namespace geoprior::sketch {
namespace {

/// Circles of the body: the mirror plane is z = 0, x rearwards, y up.
class LayeredBody {
 public:
  explicit LayeredBody(const SyntheticLayerOptions& options) : o_(options) {
    const double yaw = o_.yaw_deg * kDegree, pitch = o_.pitch_deg * kDegree;
    to_view_ = (Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()) *
                Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()))
                   .toRotationMatrix();
  }

  SyntheticView draw() {
    out_.view.kind = ViewKind::photo;
    out_.height = o_.length;
    out_.mirror_normal = to_view_.col(2);
    if (out_.mirror_normal.z() < 0) out_.mirror_normal *= -1;
    out_.axis = to_view_ * axis_at(0);
    for (int k = 0; k < o_.arcs; ++k) draw_arc(k);
    draw_axis_vector("sym-a", {0, o_.length / 2, 0});
    draw_axis_vector("sym-b", {o_.length / 2, 0, 0});
    return std::move(out_);
  }

 private:
  /// Angle of the line of centres, from half of the bend upwards to half downwards.
  [[nodiscard]] double turn(double k) const {
    return o_.bend_deg * kDegree * (k / (o_.arcs - 1) - 0.5);
  }
  /// The first circle has the second's axis, turned by the tilt.
  [[nodiscard]] Eigen::Vector3d axis_at(int k) const {
    const double a = k == 0 ? turn(1) + o_.first_tilt_deg * kDegree : turn(k);
    return {std::cos(a), -std::sin(a), 0};
  }
  /// The line of centres by its chords, each in the direction of the circle it ends at.
  [[nodiscard]] Eigen::Vector3d centre(int k) const {
    Eigen::Vector3d c = Eigen::Vector3d::Zero();
    for (int i = 1; i <= k; ++i) c += o_.length / (o_.arcs - 1) * axis_at(i);
    return c;
  }
  [[nodiscard]] double radius(int k) const {
    const double x = 2.0 * k / (o_.arcs - 1) - 1;
    const double slope = (o_.rear_radius.value_or(o_.end_radius) - o_.end_radius) / 2;
    return o_.end_radius + (o_.radius - o_.end_radius) * (1 - x * x) + slope * x * (1 + x);
  }

  void add(const std::string& id, StrokeKind kind, const std::vector<Eigen::Vector3d>& points,
           double spread) {
    RandomStream random(static_cast<std::uint64_t>(o_.seed), "drawing of " + id);
    Stroke stroke;
    stroke.id = id;
    stroke.name = id;
    stroke.kind = kind;
    std::vector<Eigen::Vector3d> truth;
    for (const Eigen::Vector3d& p : points) {
      truth.emplace_back(to_view_ * p);
      const double dx = spread * random.normal();
      const double dy = spread * random.normal();
      stroke.points.emplace_back(truth.back().x() + dx, truth.back().y() + dy);
    }
    out_.view.strokes.push_back(stroke);
    out_.truth.push_back(truth);
  }

  /// From the far side, where the body hides it, to the end of the arc on the side of the eye.
  void draw_arc(int k) {
    const Eigen::Vector3d axis = axis_at(k), across = Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d up = across.cross(axis);
    const double near = o_.half_angle_deg * kDegree * (to_view_(2, 2) >= 0 ? 1 : -1);
    const double far = -near * (1 - o_.hidden_deg / o_.half_angle_deg);
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < o_.points; ++i) {
      const double s = far + (near - far) * i / (o_.points - 1);
      points.emplace_back(centre(k) + radius(k) * (std::cos(s) * up + std::sin(s) * across));
    }
    add("arc-" + std::to_string(k + 1), StrokeKind::arc, points, o_.noise * o_.length);
  }

  void draw_axis_vector(const std::string& name, const Eigen::Vector3d& head) {
    add(name, StrokeKind::plane_vector, {{0, 0, 0}, head}, 0);
    out_.view.strokes.back().side = (to_view_ * head).z() >= 0 ? DepthSide::front : DepthSide::back;
  }

  SyntheticLayerOptions o_;
  Eigen::Matrix3d to_view_;
  SyntheticView out_;
};

}  // namespace

void describe(OptionVisitor& v, SyntheticLayerOptions& o) {
  const auto size = [&](const char* key, double& x, const char* doc) {
    v.value(key, x, {.doc = doc, .unit = "m", .min = 1e-3, .max = 1e3});
  };
  const auto angle = [&](const char* key, double& x, const char* doc, double least, double most) {
    v.value(key, x, {.doc = doc, .unit = "deg", .min = least, .max = most});
  };
  v.value("arcs", o.arcs, {.doc = "number of arcs, one more than layers", .min = 2, .max = 200});
  size("radius", o.radius, "radius of the widest circle");
  size("end_radius", o.end_radius, "radius of the first and the last circle");
  v.value("rear_radius", o.rear_radius,
          {.doc = "radius of the last circle; absent: that of the first",
           .unit = "m",
           .min = 1e-3,
           .max = 1e3});
  size("length", o.length, "length of the line of centres");
  angle("bend_deg", o.bend_deg, "turn of the line of centres from first to last circle", -180, 180);
  angle("first_tilt_deg", o.first_tilt_deg,
        "angle from the second circle's axis to the first one's, the crown rearwards", -60, 60);
  angle("half_angle_deg", o.half_angle_deg, "half the angle of every arc", 10, 170);
  angle("hidden_deg", o.hidden_deg, "angle of every arc, at its far end, that is not drawn", 0,
        320);
  angle("yaw_deg", o.yaw_deg, "angle of the mirror plane's normal from the eye's direction", -180,
        180);
  angle("pitch_deg", o.pitch_deg, "angle of the eye above the horizon", -90, 90);
  v.value("points", o.points, {.doc = "points drawn on an arc", .min = 5, .max = 10000});
  v.value("noise", o.noise,
          {.doc = "standard deviation of drawn points, over the length", .min = 0, .max = 1});
  v.value("seed", o.seed, {.doc = "seed of the noise", .min = 0, .max = 1000000000});
}

SyntheticView synthetic_layers(const SyntheticLayerOptions& options) {
  constexpr double kLeastDrawn = 20;
  if (2 * options.half_angle_deg - options.hidden_deg < kLeastDrawn) {
    throw Error("hardly any of the arcs is drawn", "synthetic layers",
                "2 half_angle_deg - hidden_deg of 20 or more");
  }
  return LayeredBody(options).draw();
}

}  // namespace geoprior::sketch
