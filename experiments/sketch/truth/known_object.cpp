#include "experiments/sketch/truth/known_object.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "core/angles.h"

namespace geoprior::sketch {
namespace {

using SpaceCurve = std::function<Eigen::Vector3d(double)>;

/// Points of a border, and rulings of a panel.
constexpr int kBorderPoints = 72;
constexpr int kRulings = 240;

/// `count` points at even distances, ends included, of a curve over [0, 1].
std::vector<Eigen::Vector3d> even_points(const SpaceCurve& curve, int count) {
  constexpr int kFine = 20000;
  std::vector<double> length{0};
  Eigen::Vector3d before = curve(0);
  for (int k = 1; k <= kFine; ++k) {
    const Eigen::Vector3d p = curve(static_cast<double>(k) / kFine);
    length.push_back(length.back() + (p - before).norm());
    before = p;
  }
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double wanted = length.back() * i / (count - 1);
    const auto above = std::lower_bound(length.begin() + 1, length.end() - 1, wanted);
    const auto k = above - length.begin();
    const double chord = *above - *(above - 1);
    const double t = chord > 0 ? (wanted - *(above - 1)) / chord : 0;
    points.push_back(curve((static_cast<double>(k) - 1 + t) / kFine));
  }
  return points;
}

SpaceCurve shifted(SpaceCurve curve, const Eigen::Vector3d& by) {
  return [curve = std::move(curve), by](double t) -> Eigen::Vector3d { return curve(t) + by; };
}

class ObjectBuilder {
 public:
  void border(const std::string& id, const std::string& panels, const SpaceCurve& curve,
              bool closed = false, int points = kBorderPoints) {
    std::vector<Eigen::Vector3d> even = even_points(curve, closed ? points + 1 : points);
    if (closed) even.pop_back();
    object.borders.push_back({id, panels, closed, std::move(even)});
  }
  void straight(const std::string& id, const std::string& panels, const Eigen::Vector3d& a,
                const Eigen::Vector3d& b) {
    object.borders.push_back({id, panels, false, {a, b}});
  }
  /// Rulings join equal parameters.
  void ruled(const std::string& name, const SpaceCurve& first, const SpaceCurve& second) {
    KnownPanel panel{name, false, {}, {}};
    for (int k = 0; k <= kRulings; ++k) {
      const double t = static_cast<double>(k) / kRulings;
      panel.first.push_back(first(t));
      panel.second.push_back(second(t));
    }
    object.panels.push_back(std::move(panel));
  }
  void flat(const std::string& name, const SpaceCurve& outline) {
    object.panels.push_back({name, true, even_points(outline, kRulings), {}});
  }
  void pair(const std::string& panels, const Eigen::Vector3d& point) {
    object.pairs.push_back({"", panels, point});
  }

  KnownObject object;
};

/// Outline of the bag in the plane z = 0, from its upper left corner over the bottom to the right:
/// two superellipses of exponent above 2, which meet with curvature 0.
Eigen::Vector3d bag_outline(double t) {
  constexpr double kHalfWidth = 0.17, kMiddle = 0.11, kAbove = 0.16, kExponent = 2.6;
  constexpr double kTop = 0.21;
  const double rise = (kTop - kMiddle) / kAbove;
  const double top_angle = std::asin(std::pow(rise, kExponent / 2));
  const double angle =
      std::numbers::pi - top_angle + t * (std::numbers::pi + 2 * top_angle);  // pi is the left
  const auto power = [](double x) {
    return std::copysign(std::pow(std::abs(x), 2 / kExponent), x);
  };
  const double y = power(std::sin(angle));
  return {kHalfWidth * power(std::cos(angle)), kMiddle + (y > 0 ? kAbove : kMiddle) * y, 0};
}

/// Profile of the flap at x = 0, from the back over the top to the front.
Eigen::Vector3d flap_profile(double t) {
  constexpr double kBack = 0.03, kFront = 0.12, kRadius = 0.057, kRise = 0.03, kLevel = 0.2;
  const double s = t * (kBack + kFront + std::numbers::pi * 0.045);
  if (s < kBack) return {0, kLevel - kBack + s, -kRadius};
  const double turn = (s - kBack) / 0.045;
  if (turn > std::numbers::pi) return {0, kLevel - 0.045 * (turn - std::numbers::pi), kRadius};
  return {0, kLevel + kRise * std::sin(turn), -kRadius * std::cos(turn)};
}

KnownObject known_bag() {
  constexpr double kHalfDepth = 0.05, kFlap = 0.115, kStrap = 0.013;
  ObjectBuilder b;
  const SpaceCurve front = shifted(bag_outline, {0, 0, kHalfDepth});
  const SpaceCurve back = shifted(bag_outline, {0, 0, -kHalfDepth});
  b.border("front-outline", "flat-front + gusset", front);
  b.border("back-outline", "gusset + flat-back", back);
  b.straight("front-top", "flat-front", front(0), front(1));
  b.straight("back-top", "flat-back", back(0), back(1));
  const SpaceCurve left = shifted(flap_profile, {-kFlap, 0, 0});
  const SpaceCurve right = shifted(flap_profile, {kFlap, 0, 0});
  b.border("flap-left", "flap", left);
  b.border("flap-right", "flap", right);
  const SpaceCurve strap = [](double t) -> Eigen::Vector3d {
    const double angle = std::numbers::pi * (1 - t);
    return {0.08 * std::cos(angle), 0.227 + 0.1 * std::sin(angle), 0.018};
  };
  const SpaceCurve strap_front = shifted(strap, {0, 0, kStrap});
  const SpaceCurve strap_back = shifted(strap, {0, 0, -kStrap});
  b.border("strap-front", "strap", strap_front);
  b.border("strap-back", "strap", strap_back);
  b.flat("flat-back", back);
  b.ruled("gusset", front, back);
  b.flat("flat-front", front);
  b.ruled("flap", left, right);
  b.ruled("strap", strap_front, strap_back);
  for (const double t : {0.0, 0.12, 0.28, 0.4}) b.pair("flat-front + gusset", front(t));
  b.pair("gusset + flat-back", back(0.5));
  b.pair("flat-back", (back(0) + back(1)) / 2);
  for (const double t : {0.0, 0.55, 0.75, 1.0}) b.pair("flap", left(t));
  for (const double t : {0.0, 0.25}) b.pair("strap", strap_front(t));
  b.pair("strap", strap_back(0.4));
  b.object.vectors = {0, 0, kHalfDepth};
  b.object.vector_sizes = {0.1, 0.1};
  b.object.height = 0.326;
  return std::move(b.object);
}

/// Arch of the tent in the plane z, from left to right.
SpaceCurve tent_arch(double scale, double z) {
  return [=](double t) -> Eigen::Vector3d {
    const double angle = std::numbers::pi * (1 - t);
    return {0.5 * scale * std::cos(angle), 0.625 * scale * std::sin(angle), z};
  };
}

KnownObject known_tent() {
  ObjectBuilder b;
  const SpaceCurve door = tent_arch(0.72, 1.05), front = tent_arch(1, 0.55),
                   middle = tent_arch(1, -0.2), rear = tent_arch(0.62, -0.95);
  b.border("arch-door", "flat-door + porch", door);
  b.border("arch-front", "porch + room", front);
  b.border("arch-middle", "room + tail", middle);
  b.border("arch-rear", "tail + flat-rear", rear);
  b.straight("door-sill", "flat-door", door(0), door(1));
  b.straight("rear-sill", "flat-rear", rear(0), rear(1));
  b.flat("flat-door", door);
  b.ruled("porch", door, front);
  b.ruled("room", front, middle);
  b.ruled("tail", middle, rear);
  b.flat("flat-rear", rear);
  for (const double t : {0.0, 0.15, 0.3, 0.5}) b.pair("flat-door + porch", door(t));
  b.pair("porch + room", front(0.4));
  b.pair("room + tail", middle(0.4));
  b.pair("tail + flat-rear", rear(0.4));
  b.object.vectors = {0, 0, 1.05};
  b.object.vector_sizes = {0.4, 0.4};
  b.object.height = 0.625;
  b.object.pitch_deg = 28;
  b.object.drawing_scale = 5;
  return std::move(b.object);
}

/// Level of the helmet: an ellipse from the right side towards the front.
SpaceCurve helmet_ring(double scale, double y) {
  return [=](double t) -> Eigen::Vector3d {
    const double angle = kFullTurn * t;
    return {0.1 * scale * std::cos(angle), y, 0.12 * scale * std::sin(angle)};
  };
}

KnownObject known_helmet() {
  constexpr double kComb = 0.012;
  ObjectBuilder b;
  const SpaceCurve hem = helmet_ring(1.4, -0.035), brow = helmet_ring(1, 0),
                   band = helmet_ring(1, 0.05), bowl = helmet_ring(0.9, 0.095),
                   crown = helmet_ring(0.66, 0.145), tip = helmet_ring(0.25, 0.185);
  b.border("hem", "brim", hem, true);
  b.border("brow", "brim + brow-band", brow, true);
  b.border("band", "brow-band + bowl", band, true);
  b.border("bowl-top", "bowl + shoulder", bowl, true);
  b.border("shoulder-top", "shoulder + crown", crown, true);
  b.border("tip", "crown + flat-tip", tip, true);
  const SpaceCurve comb = [](double t) -> Eigen::Vector3d {
    const double angle = (10 + 160 * t) * kDegree;
    return {0, 0.04 + 0.157 * std::sin(angle), 0.124 * std::cos(angle)};
  };
  const SpaceCurve left = shifted(comb, {-kComb, 0, 0}), right = shifted(comb, {kComb, 0, 0});
  b.border("comb-left", "comb", left);
  b.border("comb-right", "comb", right);
  b.ruled("brim", hem, brow);
  b.ruled("brow-band", brow, band);
  b.ruled("bowl", band, bowl);
  b.ruled("shoulder", bowl, crown);
  b.ruled("crown", crown, tip);
  b.flat("flat-tip", tip);
  b.ruled("comb", left, right);
  for (const double t : {0.02, 0.09, 0.16}) b.pair("brim", hem(t));
  b.pair("brim + brow-band", brow(0.25));
  b.pair("brow-band + bowl", band(0.25));
  b.pair("bowl + shoulder", bowl(0.25));
  b.pair("shoulder + crown", crown(0.25));
  b.pair("crown + flat-tip", tip(0.25));
  for (const double t : {0.0, 0.25, 0.5, 1.0}) b.pair("comb", left(t));
  b.object.vectors = {0, 0, 0.12};
  b.object.vector_sizes = {0.1, 0.1};
  b.object.height = 0.232;
  b.object.pitch_deg = 22;
  return std::move(b.object);
}

KnownObject known_frustum() {
  ObjectBuilder b;
  const auto rim = [](double radius, double y) -> SpaceCurve {
    return [=](double t) -> Eigen::Vector3d {
      return {radius * std::cos(kFullTurn * t), y, radius * std::sin(kFullTurn * t)};
    };
  };
  const SpaceCurve bottom = rim(0.1, 0), top = rim(0.06, 0.15);
  b.border("bottom", "shade", bottom, true);
  b.border("top", "shade", top, true);
  b.ruled("shade", bottom, top);
  for (const double t : {0.12, 0.16, 0.2}) b.pair("shade", bottom(t));
  b.pair("shade", top(0.25));
  b.object.vectors = {0, 0, 0};
  b.object.vector_sizes = {0.15, 0.15};
  b.object.height = 0.15;
  return std::move(b.object);
}

}  // namespace

KnownObject known_object(KnownShape shape) {
  KnownObject object = shape == KnownShape::bag      ? known_bag()
                       : shape == KnownShape::tent   ? known_tent()
                       : shape == KnownShape::helmet ? known_helmet()
                                                     : known_frustum();
  for (std::size_t k = 0; k < object.pairs.size(); ++k)
    object.pairs[k].id = "pair-" + std::to_string(k + 1);
  return object;
}

TriMesh panel_mesh(const KnownPanel& panel) {
  TriMesh mesh;
  const Eigen::Index n = panel.first.size();
  const auto put = [&](Eigen::Index row, const Eigen::Vector3d& p) {
    mesh.V.row(row) = p.transpose();
  };
  if (panel.flat) {
    mesh.V.resize(n + 1, 3);
    mesh.F.resize(n, 3);
    Eigen::Vector3d centre(0, 0, 0);
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::Vector3d& p = panel.first[i];
      put(i, p);
      centre += p / static_cast<double>(n);
      mesh.F.row(i) << static_cast<int>(i), static_cast<int>((i + 1) % n), static_cast<int>(n);
    }
    put(n, centre);
    return mesh;
  }
  mesh.V.resize(2 * n, 3);
  mesh.F.resize(2 * (n - 1), 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    put(2 * i, panel.first[i]);
    put(2 * i + 1, panel.second[i]);
    if (i + 1 == n) break;
    const int a = static_cast<int>(2 * i);
    mesh.F.row(2 * i) << a, a + 2, a + 1;
    mesh.F.row(2 * i + 1) << a + 1, a + 2, a + 3;
  }
  return mesh;
}

}  // namespace geoprior::sketch
