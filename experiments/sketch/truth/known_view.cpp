#include "experiments/sketch/truth/known_view.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "core/geometry/planar.h"
#include "core/random.h"

namespace geoprior::sketch {
namespace {

/// Of the object's height: blank border of the page, and half the length of a tick in the plane.
constexpr double kPageMargin = 0.08;
constexpr double kTick = 0.001;
/// Of the height: what covers a point is nearer by more than this.
constexpr double kCovers = 0.01;

/// Draws a known object.
class KnownDrawing {
 public:
  KnownDrawing(const KnownObject& object, bool visible_only)
      : object_(object),
        visible_only_(visible_only),
        place_(known_placement(object)),
        seen_(placed_panels(object, place_)) {}
  SyntheticView draw();

 private:
  [[nodiscard]] bool is_hidden(const Eigen::Vector3d& placed) const;
  Stroke& add(const std::string& id, StrokeKind kind, const std::vector<Eigen::Vector3d>& placed);
  [[nodiscard]] std::vector<Eigen::Vector3d> placed(const std::vector<Eigen::Vector3d>& p) const;
  void draw_borders();
  void draw_visible(const KnownBorder& border);
  [[nodiscard]] Eigen::Vector3d last_seen(Eigen::Vector3d seen, Eigen::Vector3d hidden) const;
  void draw_hidden(const std::string& id, std::vector<Eigen::Vector3d> points, bool closed);
  void draw_rulings(const KnownPanel& panel);
  [[nodiscard]] KnownPanel shown_part(const KnownPanel& panel) const;
  [[nodiscard]] std::vector<const KnownPanel*> row_of(const KnownPanel& panel) const;
  void draw_pairs();
  void draw_vector(const std::string& name, const Eigen::Vector3d& head);

  const KnownObject& object_;
  bool visible_only_;
  KnownPlacement place_;
  PlacedPanels seen_;
  SyntheticView out_;
};

/// Whether a triangle lies between the point and the eye.
bool KnownDrawing::is_hidden(const Eigen::Vector3d& p) const {
  const Eigen::Vector2d q = p.head<2>();
  for (Eigen::Index t = 0; t < seen_.mesh.F.rows(); ++t) {
    std::array<Eigen::Vector3d, 3> c;
    for (int k = 0; k < 3; ++k) c[k] = seen_.mesh.V.row(seen_.mesh.F(t, k)).transpose();
    const Eigen::Vector2d a = c[0].head<2>(), b = c[1].head<2>(), d = c[2].head<2>();
    const double whole = cross(b - a, d - a);
    if (whole == 0) continue;
    const double u = cross(b - q, d - q) / whole, v = cross(d - q, a - q) / whole, w = 1 - u - v;
    if (u < 0 || v < 0 || w < 0) continue;
    if (u * c[0].z() + v * c[1].z() + w * c[2].z() > p.z() + kCovers * object_.height) return true;
  }
  return false;
}

Stroke& KnownDrawing::add(const std::string& id, StrokeKind kind,
                          const std::vector<Eigen::Vector3d>& points) {
  Stroke stroke;
  stroke.id = id;
  stroke.kind = kind;
  for (const Eigen::Vector3d& p : points) stroke.points.emplace_back(p.head<2>());
  out_.view.strokes.push_back(std::move(stroke));
  out_.truth.push_back(points);
  return out_.view.strokes.back();
}

std::vector<Eigen::Vector3d> KnownDrawing::placed(const std::vector<Eigen::Vector3d>& p) const {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& q : p) points.push_back(place_(q));
  return points;
}

/// A straight border is looked at in between.
std::vector<Eigen::Vector3d> looked_at(const std::vector<Eigen::Vector3d>& points) {
  constexpr int kBetween = 24;
  if (points.size() != 2) return points;
  std::vector<Eigen::Vector3d> dense;
  for (int k = 0; k <= kBetween; ++k)
    dense.emplace_back(points[0] + (points[1] - points[0]) * (static_cast<double>(k) / kBetween));
  return dense;
}

/// The point between a seen and a hidden one where something begins to cover the border.
Eigen::Vector3d KnownDrawing::last_seen(Eigen::Vector3d seen, Eigen::Vector3d hidden) const {
  constexpr int kHalvings = 7;
  for (int k = 0; k < kHalvings; ++k) {
    const Eigen::Vector3d middle = (seen + hidden) / 2;
    (is_hidden(middle) ? hidden : seen) = middle;
  }
  return seen;
}

/// One stroke for each stretch that is seen; the whole border where nothing hides it.
void KnownDrawing::draw_visible(const KnownBorder& border) {
  const std::vector<Eigen::Vector3d> points = looked_at(placed(border.points));
  const std::size_t n = points.size();
  std::vector<bool> hidden;
  for (const Eigen::Vector3d& p : points) hidden.push_back(is_hidden(p));
  const auto covered = std::find(hidden.begin(), hidden.end(), true);
  if (covered == hidden.end()) {
    Stroke& stroke = add(border.id, StrokeKind::border, placed(border.points));
    stroke.name = border.panels;
    stroke.closed = border.closed;
    return;
  }
  const std::size_t start = border.closed ? static_cast<std::size_t>(covered - hidden.begin()) : 0;
  std::vector<Eigen::Vector3d> run;
  int number = 0;
  for (std::size_t k = 0; k <= n; ++k) {
    const std::size_t i = (start + k) % n, before = (start + k + n - 1) % n;
    const bool inside = border.closed || k < n;  // a ring comes back to its hidden start
    if (inside && !hidden[i]) {
      if (run.empty() && (border.closed || k > 0))
        run.push_back(last_seen(points[i], points[before]));
      run.push_back(points[i]);
      continue;
    }
    if (inside && !run.empty()) run.push_back(last_seen(points[before], points[i]));
    if (run.size() > 2) {
      const std::string suffix = ++number > 1 ? "-" + std::to_string(number) : "";
      add(border.id + suffix, StrokeKind::border, run).name = border.panels;
    }
    run.clear();
  }
}

void KnownDrawing::draw_borders() {
  for (const KnownBorder& border : object_.borders) {
    out_.borders.push_back(placed(border.points));
    if (border.closed) out_.borders.back().push_back(out_.borders.back().front());
  }
  if (visible_only_) {
    for (const KnownBorder& border : object_.borders) draw_visible(border);
    return;
  }
  for (const KnownBorder& border : object_.borders) {
    Stroke& stroke = add(border.id, StrokeKind::border, placed(border.points));
    stroke.name = border.panels;
    stroke.closed = border.closed;
  }
  for (const KnownBorder& border : object_.borders)
    draw_hidden(border.id, placed(border.points), border.closed);
}

/// One occlusion for each hidden run of the points.
void KnownDrawing::draw_hidden(const std::string& id, std::vector<Eigen::Vector3d> points,
                               bool closed) {
  points = looked_at(points);
  const std::size_t n = points.size();
  std::vector<bool> hidden;
  for (const Eigen::Vector3d& p : points) hidden.push_back(is_hidden(p));
  const auto seen = std::find(hidden.begin(), hidden.end(), false);
  const std::size_t start = closed && seen != hidden.end()
                                ? static_cast<std::size_t>(seen - hidden.begin())
                                : std::size_t{0};
  std::vector<Eigen::Vector3d> run;
  int number = 0;
  for (std::size_t k = 0; k <= n; ++k) {
    if (k < n && hidden[(start + k) % n]) {
      run.push_back(points[(start + k) % n]);
      continue;
    }
    if (run.size() > 2) add(id + "-hidden-" + std::to_string(++number), StrokeKind::occlusion, run);
    run.clear();
  }
}

void KnownDrawing::draw_rulings(const KnownPanel& panel) {
  const std::vector<Eigen::Vector3d> a = placed(panel.first), b = placed(panel.second);
  const std::size_t n = a.size();
  // The normal T x r is orthogonal to the view where the images of T and r are parallel.
  const auto turn = [&](std::size_t k) {
    const std::size_t i = std::max<std::size_t>(k, 1) - 1, j = std::min(k + 1, n - 1);
    return cross((a[j] - a[i] + b[j] - b[i]).head<2>(), (b[k] - a[k]).head<2>());
  };
  const auto between = [&](const std::vector<Eigen::Vector3d>& p, std::size_t k, double t) {
    return Eigen::Vector3d((1 - t) * p[k] + t * p[k + 1]);
  };
  int number = 0;
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double here = turn(k), next = turn(k + 1);
    if (!(here * next < 0)) continue;
    const double t = here / (here - next);
    const Eigen::Vector3d p = between(a, k, t), q = between(b, k, t);
    if (is_hidden((p + q) / 2)) continue;
    add(panel.name + "-silhouette-" + std::to_string(++number), StrokeKind::silhouette, {p, q})
        .name = panel.name;
  }
  if (number > 0) return;
  std::vector<std::size_t> seen;
  for (std::size_t k = 0; k < n; ++k)
    if (!is_hidden(a[k]) && !is_hidden(b[k]) && !is_hidden((a[k] + b[k]) / 2)) seen.push_back(k);
  if (seen.empty()) return;
  const std::size_t k = seen[seen.size() / 2];
  add(panel.name + "-ruling", StrokeKind::ruling, {a[k], b[k]}).name = panel.name;
}

/// The ruled panels that follow each other from border to border, this one among them.
std::vector<const KnownPanel*> KnownDrawing::row_of(const KnownPanel& panel) const {
  std::vector<const KnownPanel*> row{&panel};
  for (std::size_t k = 0; k < row.size(); ++k) {
    for (const KnownPanel& other : object_.panels) {
      const bool follows = other.first == row[k]->second || other.second == row[k]->first;
      if (!other.flat && follows && std::find(row.begin(), row.end(), &other) == row.end())
        row.push_back(&other);
    }
  }
  return row;
}

/// A ruled panel up to the last places where a border of its row of panels is seen: how far an open
/// row goes on where all are hidden, no drawing of visible borders tells.
KnownPanel KnownDrawing::shown_part(const KnownPanel& panel) const {
  const bool closed = (panel.first.front() - panel.first.back()).norm() < 1e-9 * object_.height;
  if (!visible_only_ || panel.flat || closed) return panel;
  const std::vector<const KnownPanel*> row = row_of(panel);
  const auto is_shown = [&](std::size_t k) {
    return std::any_of(row.begin(), row.end(), [&](const KnownPanel* p) {
      return !is_hidden(place_(p->first[k])) || !is_hidden(place_(p->second[k]));
    });
  };
  std::size_t begin = 0, end = panel.first.size();
  while (begin < end && !is_shown(begin)) ++begin;
  while (end > begin && !is_shown(end - 1)) --end;
  const auto part = [&](const std::vector<Eigen::Vector3d>& p) {
    return std::vector<Eigen::Vector3d>(p.begin() + static_cast<std::ptrdiff_t>(begin),
                                        p.begin() + static_cast<std::ptrdiff_t>(end));
  };
  return {panel.name, false, part(panel.first), part(panel.second)};
}

void KnownDrawing::draw_pairs() {
  for (const KnownPair& pair : object_.pairs) {
    Eigen::Vector3d p = pair.point;
    // A point of the plane is a tick: a stroke has two different ends.
    if (std::abs(p.x()) < kTick * object_.height) p.x() = -kTick * object_.height;
    const Eigen::Vector3d image(-p.x(), p.y(), p.z());
    if (visible_only_ && (is_hidden(place_(p)) || is_hidden(place_(image)))) continue;
    Stroke& stroke = add(pair.id, StrokeKind::symmetric_pair, {place_(p), place_(image)});
    stroke.name = pair.id;
    stroke.panels = pair.panels;
  }
}

void KnownDrawing::draw_vector(const std::string& name, const Eigen::Vector3d& head) {
  const Eigen::Vector3d tail = place_(object_.vectors);
  Stroke& stroke = add(name, StrokeKind::plane_vector, {tail, place_(object_.vectors + head)});
  stroke.name = name;
  stroke.side = (place_.frame * head).z() >= 0 ? DepthSide::front : DepthSide::back;
}

SyntheticView KnownDrawing::draw() {
  out_.view.kind = ViewKind::photo;
  out_.height = object_.height;
  out_.mirror_normal = place_.frame.col(0);
  if (out_.mirror_normal.z() < 0) out_.mirror_normal *= -1;
  out_.axis = place_.frame.col(1);
  draw_borders();
  for (const KnownPanel& panel : object_.panels) {
    if (!panel.flat) draw_rulings(panel);
    const KnownPanel shown = shown_part(panel);
    if (shown.first.size() < 2) continue;  // hidden whole
    const TriMesh mesh = panel_mesh(shown);
    out_.panel_areas[panel.name] = triangle_areas(mesh.V, mesh.F).sum();
  }
  draw_pairs();
  draw_vector("sym-a", {0, object_.vector_sizes.x(), 0});
  draw_vector("sym-b", {0, 0, object_.vector_sizes.y()});
  return std::move(out_);
}

}  // namespace

KnownPlacement known_placement(const KnownObject& object) {
  KnownPlacement place;
  place.frame = turned_view(object.yaw_deg, object.pitch_deg);
  Eigen::AlignedBox2d box;
  for (const KnownPanel& panel : object.panels) {
    for (const Eigen::Vector3d& p : panel.first) box.extend((place.frame * p).head<2>());
    for (const Eigen::Vector3d& p : panel.second) box.extend((place.frame * p).head<2>());
  }
  const double margin = kPageMargin * object.height;
  // Whole centimetres of paper.
  const double unit = 0.01 * object.drawing_scale;
  for (int k = 0; k < 2; ++k)
    place.page(k) = unit * std::ceil((box.sizes()(k) + 2 * margin) / unit);
  place.shift.head<2>() = place.page / 2 - box.center();
  return place;
}

PlacedPanels placed_panels(const KnownObject& object, const KnownPlacement& placement) {
  PlacedPanels placed;
  for (int p = 0; p < std::ssize(object.panels); ++p) {
    const TriMesh panel = panel_mesh(object.panels[p]);
    const Eigen::Index n = placed.mesh.V.rows(), m = placed.mesh.F.rows();
    placed.mesh.V.conservativeResize(n + panel.V.rows(), 3);
    placed.mesh.F.conservativeResize(m + panel.F.rows(), 3);
    for (Eigen::Index v = 0; v < panel.V.rows(); ++v)
      placed.mesh.V.row(n + v) = placement(panel.V.row(v).transpose()).transpose();
    placed.mesh.F.bottomRows(panel.F.rows()) = panel.F.array() + static_cast<int>(n);
    placed.panel.insert(placed.panel.end(), panel.F.rows(), p);
  }
  return placed;
}

SyntheticView known_view(const KnownObject& object, bool visible_only) {
  return KnownDrawing(object, visible_only).draw();
}

void add_drawing_noise(View& view, double spread, std::uint64_t seed, bool noisy_vectors) {
  constexpr double kShort = 8;     // spreads, below which both ends of a pair are one mark
  constexpr double kMeet = 0.001;  // of the diagonal, within which ends of borders are one corner
  Eigen::AlignedBox2d box;
  for (const Stroke& stroke : view.strokes)
    for (const Eigen::Vector2d& p : stroke.points) box.extend(p);
  std::vector<std::array<Eigen::Vector2d, 2>> corners;  // place and where it went
  for (Stroke& stroke : view.strokes) {
    if (stroke.kind == StrokeKind::plane_vector && !noisy_vectors) continue;
    RandomStream random(seed, "drawing of " + stroke.id);
    const auto move = [&]() -> Eigen::Vector2d {
      const double dx = spread * random.normal();
      const double dy = spread * random.normal();
      return {dx, dy};
    };
    const bool mark = stroke.kind == StrokeKind::symmetric_pair && length(stroke) < kShort * spread;
    const Eigen::Vector2d whole = mark ? move() : Eigen::Vector2d(0, 0);
    std::vector<Eigen::Vector2d*> ends;
    if (stroke.kind == StrokeKind::border && !stroke.closed)
      ends = {&stroke.points.front(), &stroke.points.back()};
    for (Eigen::Vector2d& p : stroke.points) {
      const Eigen::Vector2d before = p;
      p += mark ? whole : move();
      if (std::find(ends.begin(), ends.end(), &p) == ends.end()) continue;
      const auto met = std::find_if(corners.begin(), corners.end(), [&](const auto& corner) {
        return (corner[0] - before).norm() <= kMeet * box.diagonal().norm();
      });
      if (met != corners.end()) p = (*met)[1];
      if (met == corners.end()) corners.push_back({before, p});
    }
  }
}

}  // namespace geoprior::sketch
