#include "experiments/sketch/truth/synthetic_views.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "core/angles.h"
#include "core/error.h"
#include "core/random.h"

namespace geoprior::sketch {
namespace {

constexpr std::array<std::string_view, 2> kShapeNames{"frustum", "tent"};

/// Puts points of the object into the view and strokes into the drawing.
class SyntheticDrawing {
 public:
  explicit SyntheticDrawing(const SyntheticViewOptions& options);
  SyntheticView draw();

 private:
  [[nodiscard]] Eigen::Vector3d in_view(const Eigen::Vector3d& p) const { return to_view_ * p; }
  [[nodiscard]] Eigen::Vector3d circle(bool top, double azimuth) const {
    const double r = top ? o_.top_radius : o_.radius;
    return {r * std::cos(azimuth), top ? o_.height : 0.0, r * std::sin(azimuth)};
  }
  Stroke& add(const std::string& id, StrokeKind kind, const std::vector<Eigen::Vector3d>& points,
              bool noisy = true);
  void draw_frustum();
  void draw_circle(const std::string& id, bool top);
  void draw_pairs(const std::string& id, bool top, int count);
  void draw_tent();
  void draw_edge(const std::string& panels, const Eigen::Vector3d& a, const Eigen::Vector3d& b);
  void draw_vector(const std::string& name, const Eigen::Vector3d& head);

  SyntheticViewOptions o_;
  Eigen::Matrix3d to_view_;
  SyntheticView out_;
};

SyntheticDrawing::SyntheticDrawing(const SyntheticViewOptions& options)
    : o_(options), to_view_(turned_view(options.yaw_deg, options.pitch_deg)) {
  out_.view.kind = ViewKind::photo;
  out_.height = o_.height;
  // The mirror plane is x = 0 of the object.
  out_.mirror_normal = in_view({1, 0, 0});
  if (out_.mirror_normal.z() < 0) out_.mirror_normal *= -1;
  out_.axis = in_view({0, 1, 0});
}

Stroke& SyntheticDrawing::add(const std::string& id, StrokeKind kind,
                              const std::vector<Eigen::Vector3d>& points, bool noisy) {
  RandomStream random(static_cast<std::uint64_t>(o_.seed), "drawing of " + id);
  Stroke stroke;
  stroke.id = id;
  stroke.kind = kind;
  std::vector<Eigen::Vector3d> truth;
  for (const Eigen::Vector3d& p : points) {
    truth.push_back(in_view(p));
    const double spread = noisy ? o_.noise * o_.height : 0;
    const double dx = spread * random.normal();
    const double dy = spread * random.normal();
    stroke.points.emplace_back(truth.back().x() + dx, truth.back().y() + dy);
  }
  out_.view.strokes.push_back(stroke);
  out_.truth.push_back(truth);
  return out_.view.strokes.back();
}

void SyntheticDrawing::draw_circle(const std::string& id, bool top) {
  std::vector<Eigen::Vector3d> points;
  for (int k = 0; k < o_.points; ++k) points.push_back(circle(top, kFullTurn * k / o_.points));
  add(id, StrokeKind::border, points).closed = true;
}

/// Azimuths t and pi - t are symmetric in x = 0.
void SyntheticDrawing::draw_pairs(const std::string& id, bool top, int count) {
  for (int k = 0; k < count; ++k) {
    const double t = std::numbers::pi * ((k + 0.5) / count - 0.5);
    add(id + "-pair-" + std::to_string(k + 1), StrokeKind::symmetric_pair,
        {circle(top, t), circle(top, std::numbers::pi - t)});
  }
}

void SyntheticDrawing::draw_frustum() {
  draw_circle("bottom", false);
  draw_circle("top", true);
  // Normals (h cos t, r1 - r2, h sin t) are orthogonal to the direction of the eye where the
  // surface is seen edge on.
  const Eigen::Vector3d eye = to_view_.row(2).transpose();
  const double reach = o_.height * std::hypot(eye.x(), eye.z());
  const double cosine = -(o_.radius - o_.top_radius) * eye.y() / reach;
  if (!(std::abs(cosine) < 1))
    throw Error("no silhouette: the frustum is seen along its axis", "synthetic view",
                "a smaller pitch");
  const double towards = std::atan2(eye.z(), eye.x()), half = std::acos(cosine);
  for (const auto& [id, t] :
       {std::pair<std::string, double>{"left", towards + half}, {"right", towards - half}})
    add(id, StrokeKind::silhouette, {circle(false, t), circle(true, t)});
  std::vector<Eigen::Vector3d> back;
  for (int k = 0; k <= o_.points / 2; ++k) {
    const double turn = half + (kFullTurn - 2 * half) * k / (o_.points / 2);
    back.push_back(circle(false, towards + turn));
  }
  add("bottom-back", StrokeKind::occlusion, back);
  draw_pairs("bottom", false, o_.lower_pairs);
  draw_pairs("top", true, o_.upper_pairs);
  if (o_.upper_point) {
    const Eigen::Vector3d p = circle(true, std::numbers::pi / 2);
    add("top-plane-point", StrokeKind::symmetric_pair, {p});
  }
  const double narrowing = std::max(o_.radius - o_.top_radius, 1e-9);
  out_.conical = true;
  out_.apex = in_view({0, o_.height * o_.radius / narrowing, 0});
}

void SyntheticDrawing::draw_edge(const std::string& panels, const Eigen::Vector3d& a,
                                 const Eigen::Vector3d& b) {
  add("edge-" + std::to_string(out_.view.strokes.size() + 1), StrokeKind::border, {a, b}).name =
      panels;
}

void SyntheticDrawing::draw_tent() {
  const double w = o_.radius, l = o_.length / 2, h = o_.height;
  const Eigen::Vector3d ridge_back(0, h, -l), ridge_front(0, h, l);
  const Eigen::Vector3d right_back(w, 0, -l), right_front(w, 0, l);
  const Eigen::Vector3d left_back(-w, 0, -l), left_front(-w, 0, l);
  draw_edge("left + right", ridge_back, ridge_front);
  draw_edge("left", left_back, left_front);
  draw_edge("right", right_back, right_front);
  draw_edge("left + back", left_back, ridge_back);
  draw_edge("right + back", right_back, ridge_back);
  draw_edge("left + front", left_front, ridge_front);
  draw_edge("right + front", right_front, ridge_front);
  draw_edge("back", left_back, right_back);
  draw_edge("front", left_front, right_front);
  add("pair-back", StrokeKind::symmetric_pair, {left_back, right_back});
  add("pair-front", StrokeKind::symmetric_pair, {left_front, right_front});
  add("pair-ridge-back", StrokeKind::symmetric_pair, {ridge_back});
  add("pair-ridge-front", StrokeKind::symmetric_pair, {ridge_front});
}

void SyntheticDrawing::draw_vector(const std::string& name, const Eigen::Vector3d& head) {
  Stroke& stroke = add(name, StrokeKind::plane_vector, {{0, 0, 0}, head}, o_.noisy_vectors);
  stroke.name = name;
  stroke.side = in_view(head).z() >= 0 ? DepthSide::front : DepthSide::back;
}

SyntheticView SyntheticDrawing::draw() {
  if (o_.shape == SyntheticShape::tent) {
    draw_tent();
  } else {
    draw_frustum();
  }
  draw_vector("sym-a", {0, o_.height, 0});
  draw_vector("sym-b", {0, 0, o_.height});
  return std::move(out_);
}

}  // namespace

void describe(OptionVisitor& v, SyntheticViewOptions& o) {
  describe_choice(v, "shape", o.shape, kShapeNames, {.doc = "what is drawn"});
  const auto size = [&](const char* key, double& x, const char* doc) {
    v.value(key, x, {.doc = doc, .unit = "m", .min = 1e-3, .max = 1e3});
  };
  size("radius", o.radius, "radius of the lower circle; half the tent's width");
  size("top_radius", o.top_radius, "radius of the upper circle");
  size("height", o.height, "height of the shape");
  size("length", o.length, "length of the tent's ridge");
  const auto angle = [&](const char* key, double& x, const char* doc) {
    v.value(key, x, {.doc = doc, .unit = "deg", .min = -180, .max = 180});
  };
  angle("yaw_deg", o.yaw_deg, "turn of the shape about the upright axis");
  angle("pitch_deg", o.pitch_deg, "angle of the eye above the horizon");
  v.value("points", o.points, {.doc = "points drawn on a circle", .min = 12, .max = 100000});
  v.value("lower_pairs", o.lower_pairs,
          {.doc = "symmetric pairs on the lower circle", .min = 0, .max = 1000});
  v.value("upper_pairs", o.upper_pairs,
          {.doc = "symmetric pairs on the upper circle", .min = 0, .max = 1000});
  v.value("upper_point", o.upper_point,
          {.doc = "whether a point of the mirror plane is marked on the upper circle"});
  v.value("noise", o.noise,
          {.doc = "standard deviation of drawn points, over the height", .min = 0, .max = 1});
  v.value("noisy_vectors", o.noisy_vectors,
          {.doc = "whether the mirror plane's vectors are noisy too"});
  v.value("seed", o.seed, {.doc = "seed of the noise", .min = 0, .max = 1000000000});
}

Eigen::Matrix3d turned_view(double yaw_deg, double pitch_deg) {
  const double yaw = yaw_deg * kDegree, pitch = pitch_deg * kDegree;
  Eigen::Matrix3d turn, tilt;
  turn << std::cos(yaw), 0, -std::sin(yaw), 0, 1, 0, std::sin(yaw), 0, std::cos(yaw);
  tilt << 1, 0, 0, 0, std::cos(pitch), -std::sin(pitch), 0, std::sin(pitch), std::cos(pitch);
  return tilt * turn;
}

SyntheticView synthetic_view(const SyntheticViewOptions& options) {
  return SyntheticDrawing(options).draw();
}

}  // namespace geoprior::sketch
