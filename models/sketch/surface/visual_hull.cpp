#include "models/sketch/surface/visual_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/geometry/topology.h"
#include "core/limits.h"
#include "models/sketch/ridges/ridge_flips.h"
#include "models/sketch/sections/hull_sections.h"
#include "models/sketch/surface/collapse_edges.h"
#include "models/sketch/surface/nets.h"

namespace geoprior::sketch {
namespace {

/// Signed distances at the points of a plane grid, exact within two spacings of the outline and
/// bounds beyond.
struct PlaneDistances {
  std::array<int, 2> size{0, 0};
  std::vector<double> values;
};

struct HullBox {
  Eigen::Vector3d low, high;
};

/// Grid of a hull: points `origin + spacing (i, j, k)`.
struct HullGrid {
  std::array<int, 3> size{0, 0, 0};
  Eigen::Vector3d origin;
  double spacing = 0;
};

HullBox box_of(const std::vector<OutlinedView>& views) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  HullBox box{Eigen::Vector3d::Constant(-kInfinity), Eigen::Vector3d::Constant(kInfinity)};
  for (const OutlinedView& view : views) {
    for (int c = 0; c < 2; ++c) {
      const auto [axis, sign] = view_axis(view.frame, c);
      const double a = sign * view.outline.lowest()[c], b = sign * view.outline.highest()[c];
      box.low[axis] = std::max(box.low[axis], std::min(a, b));
      box.high[axis] = std::min(box.high[axis], std::max(a, b));
    }
  }
  return box;
}

/// Irrational parts of a spacing by which the grid begins before the box: planes of the drawing
/// should not lie on grid points.
constexpr std::array<double, 3> kLead{1.38196601125, 1.41421356237, 1.30277563773};

HullGrid grid_over(const HullBox& box, double spacing, int attempt) {
  HullGrid grid;
  grid.spacing = spacing;
  for (int a = 0; a < 3; ++a) {
    const double lead = kLead[a] + 0.1618033988 * attempt;
    grid.origin[a] = box.low[a] - lead * spacing;
    grid.size[a] = static_cast<int>(std::ceil((box.high[a] - grid.origin[a]) / spacing)) + 2;
  }
  return grid;
}

PlaneDistances plane_distances(const OutlinedView& view, const HullGrid& grid) {
  const std::array<int, 2> axes{view_axis(view.frame, 0).axis, view_axis(view.frame, 1).axis};
  PlaneDistances plane;
  plane.size = {grid.size[axes[0]], grid.size[axes[1]]};
  plane.values.resize(static_cast<std::size_t>(plane.size[0]) * plane.size[1]);
  Eigen::Vector3d x = grid.origin;
  for (int j = 0; j < plane.size[1]; ++j) {
    x[axes[1]] = grid.origin[axes[1]] + j * grid.spacing;
    double before = 0;
    for (int i = 0; i < plane.size[0]; ++i) {
      // A step changes the distance by at most itself: far from the outline there is nothing to
      // ask.
      double& value = plane.values[j * plane.size[0] + i];
      const double bound = std::abs(before) - grid.spacing;
      if (i > 0 && bound > 2 * grid.spacing) {
        value = std::copysign(bound, before);
      } else {
        x[axes[0]] = grid.origin[axes[0]] + i * grid.spacing;
        value = view.outline.nearest(view.project(x)).distance;
      }
      before = value;
    }
  }
  return plane;
}

GridFunction hull_function(const std::vector<OutlinedView>& views, const HullGrid& grid) {
  GridFunction f;
  f.size = grid.size;
  f.origin = grid.origin;
  f.spacing = grid.spacing;
  f.values.assign(static_cast<std::size_t>(grid.size[0]) * grid.size[1] * grid.size[2],
                  -std::numeric_limits<double>::infinity());
  for (const OutlinedView& view : views) {
    const PlaneDistances plane = plane_distances(view, grid);
    const int u = view_axis(view.frame, 0).axis, w = view_axis(view.frame, 1).axis;
    std::array<int, 3> at{};
    for (at[2] = 0; at[2] < grid.size[2]; ++at[2]) {
      for (at[1] = 0; at[1] < grid.size[1]; ++at[1]) {
        for (at[0] = 0; at[0] < grid.size[0]; ++at[0]) {
          double& value = f.values[f.index(at[0], at[1], at[2])];
          value = std::max(value, plane.values[at[w] * plane.size[0] + at[u]]);
        }
      }
    }
  }
  return f;
}

/// Moves vertices of the nets onto the faces of the hull that their cells cross: a face is a view
/// and a run of its silhouette between two corners. A vertex of two faces comes to lie on the edge
/// between them, exactly.
class SilhouetteFit {
 public:
  SilhouetteFit(const std::vector<OutlinedView>& views, double spacing,
                const SectionBounds& sections)
      : views_(views), spacing_(spacing), same_(0.02 * spacing), sections_(sections) {
    for (const OutlinedView& view : views) corners_.push_back(view.outline.corners());
  }

  [[nodiscard]] Eigen::Vector3d fitted(Eigen::Vector3d x,
                                       const std::vector<Eigen::Vector3d>& crossings) const {
    std::vector<std::set<std::size_t>> runs(views_.size());
    bool on_section = false;
    for (const Eigen::Vector3d& crossing : crossings)
      on_section = !add_faces_at(crossing, runs) || on_section;
    // Two faces that are not at right angles are met in turns.
    for (int pass = 0; pass < 8; ++pass) {
      const Eigen::Vector3d before = x;
      for (std::size_t v = 0; v < views_.size(); ++v) {
        if (runs[v].empty()) continue;
        const Eigen::Vector2d q = views_[v].project(x);
        const Outline& outline = views_[v].outline;
        const Eigen::Vector2d to = runs[v].size() == 1
                                       ? outline.nearest(q).point
                                       : outline.at(nearest_corner(v, outline.nearest(q)));
        x += views_[v].frame.topRows<2>().transpose() * (to - q);
      }
      if (on_section) x = sections_.moved_on(x, spacing_);
      if (x == before) break;
    }
    return sections_.empty() ? inside(x) : inside(on_touched_silhouettes(x));
  }

 private:
  /// Adds the runs of all silhouettes that a point of the hull is on; views may share a face.
  /// @return  false for a point that is farther out in the sections: it is on one of them
  bool add_faces_at(const Eigen::Vector3d& x, std::vector<std::set<std::size_t>>& runs) const {
    std::vector<Outline::Nearest> nearest;
    double outermost = -std::numeric_limits<double>::infinity();
    for (const OutlinedView& view : views_) {
      nearest.push_back(view.outline.nearest(view.project(x)));
      outermost = std::max(outermost, nearest.back().distance);
    }
    if (is_on_section(x, outermost)) return false;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      if (nearest[v].distance < outermost - same_) continue;
      const std::vector<double>& corners = corners_[v];
      const auto after = std::upper_bound(corners.begin(), corners.end(), nearest[v].arc_length);
      const std::size_t run = after - corners.begin();
      runs[v].insert(run == corners.size() ? 0 : run);  // the last run goes on past the first point
    }
    return true;
  }

  /// Whether the hull ends at a section near to `x`, by which is farther out. The widths of
  /// sections from the top view change with their height: their values are distances at one height.
  [[nodiscard]] bool is_on_section(const Eigen::Vector3d& x, double outermost) const {
    if (sections_.empty()) return false;
    const double value = sections_.value(x);
    const double slope = sections_.from_top() ? section_gradient(x).norm() : 1;
    return value / std::max(1.0, slope) > outermost + same_;
  }

  /// Arc length of the corner that is nearest along the outline.
  [[nodiscard]] double nearest_corner(std::size_t view, const Outline::Nearest& from) const {
    const double length = views_[view].outline.length();
    double best = from.arc_length, least = std::numeric_limits<double>::infinity();
    for (const double corner : corners_[view]) {
      const double way = std::abs(std::remainder(corner - from.arc_length, length));
      if (way < least) {
        least = way;
        best = corner;
      }
    }
    return best;
  }

  /// A round section touches a silhouette along a line between vertices. The nearest of them come
  /// onto it, if that moves them by no more than a chord of two edges on a radius of one and a half
  /// edges is off its arc.
  [[nodiscard]] Eigen::Vector3d on_touched_silhouettes(Eigen::Vector3d x) const {
    constexpr double kFarthest = 0.08;
    for (const OutlinedView& view : views_) {
      const Eigen::Vector2d q = view.project(x);
      const Outline::Nearest nearest = view.outline.nearest(q);
      if (nearest.distance > 0 || (nearest.distance > -kFarthest * spacing_ &&
                                   section_turns_near(x, view.frame.row(2).transpose())))
        x += view.frame.topRows<2>().transpose() * (nearest.point - q);
    }
    return x;
  }

  /// 0 where no section is near.
  [[nodiscard]] Eigen::Vector3d section_normal(const Eigen::Vector3d& x) const {
    return section_gradient(x).stableNormalized();
  }

  [[nodiscard]] Eigen::Vector3d section_gradient(const Eigen::Vector3d& x) const {
    const double step = 1e-4 * spacing_;
    Eigen::Vector3d gradient;
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(c);
      const double change = sections_.value(x + d) - sections_.value(x - d);
      gradient[c] = std::isfinite(change) ? change / (2 * step) : 0;
    }
    return gradient;
  }

  /// Whether the section through `x` becomes parallel to the view direction nearer than to the next
  /// vertex, by its curvature there.
  [[nodiscard]] bool section_turns_near(const Eigen::Vector3d& x,
                                        const Eigen::Vector3d& direction) const {
    constexpr double kStep = 0.25, kReach = 0.6;  // edges
    const Eigen::Vector3d normal = section_normal(x);
    const double sine = normal.dot(direction);
    const Eigen::Vector3d tangent = (direction - sine * normal).stableNormalized();
    const double toward = sine > 0 ? -kStep * spacing_ : kStep * spacing_;
    const double next = section_normal(x + toward * tangent).dot(direction);
    const double turned = std::abs(sine) - (sine > 0 ? next : -next);
    return std::abs(sine) * kStep <= kReach * turned;
  }

  /// What is outside of a silhouette comes in.
  [[nodiscard]] Eigen::Vector3d inside(Eigen::Vector3d x) const {
    for (const OutlinedView& view : views_) {
      const Eigen::Vector2d q = view.project(x);
      const Outline::Nearest nearest = view.outline.nearest(q);
      if (nearest.distance > 0) x += view.frame.topRows<2>().transpose() * (nearest.point - q);
    }
    return x;
  }

  const std::vector<OutlinedView>& views_;
  std::vector<std::vector<double>> corners_;  ///< of each view
  double spacing_;                            ///< m
  double same_;  ///< difference of distances at which two views see the same face (m)
  const SectionBounds& sections_;
};

void fit_to_silhouettes(QuadMesh& nets, const std::vector<OutlinedView>& views, double spacing,
                        const SectionBounds& sections) {
  const SilhouetteFit fit(views, spacing, sections);
  for (Eigen::Index v = 0; v < nets.V.rows(); ++v) {
    nets.V.row(v) = fit.fitted(nets.V.row(v).transpose(), nets.crossings[v]).transpose();
  }
}

/// Splits quadrilaterals along their shorter diagonals.
TriMesh split_quads(const QuadMesh& quads) {
  TriMesh mesh;
  mesh.V = quads.V;
  mesh.F.resize(2 * quads.quads.size(), 3);
  Eigen::Index t = 0;
  for (const std::array<int, 4>& q : quads.quads) {
    const double first = (mesh.V.row(q[0]) - mesh.V.row(q[2])).squaredNorm();
    const double second = (mesh.V.row(q[1]) - mesh.V.row(q[3])).squaredNorm();
    const int turn = first <= second ? 0 : 1;
    mesh.F.row(t++) << q[turn], q[turn + 1], q[turn + 2];
    mesh.F.row(t++) << q[turn], q[turn + 2], q[(turn + 3) % 4];
  }
  return mesh;
}

std::vector<std::optional<SilhouettePlace>> places_on(const OutlinedView& view,
                                                      const Eigen::MatrixX3d& V, double near) {
  std::vector<std::optional<SilhouettePlace>> places(V.rows());
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    const Outline::Nearest nearest = view.outline.nearest(view.project(V.row(v).transpose()));
    if (std::abs(nearest.distance) < near) places[v] = {nearest.arc_length, nearest.normal};
  }
  return places;
}

/// Nets at a spacing, on shifted grids until they are a manifold.
QuadMesh manifold_nets(const std::vector<OutlinedView>& views, const HullBox& box, double spacing,
                       const SectionBounds& sections) {
  constexpr int kAttempts = 6;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    const HullGrid grid = grid_over(box, spacing, attempt);
    require_memory(8.0 * grid.size[0] * grid.size[1] * grid.size[2], 1, "grid of the hull",
                   "hull.triangles");
    GridFunction f = hull_function(views, grid);
    sections.bound(f);
    QuadMesh quads = surface_nets(f);
    if (!quads.quads.empty() && non_manifold_edges(split_quads(quads).F).empty()) return quads;
  }
  throw Error("has parts that are thinner than its grid of " + std::to_string(spacing) + " m",
              "visual hull", "more triangles");
}

/// Shares of the surface's area that lie on the outlines of sections, and on the views' faces.
void measure_shares(VisualHull& hull, const SectionBounds& sections) {
  if (sections.empty()) return;
  const Eigen::VectorXd areas = triangle_areas(hull.mesh.V, hull.mesh.F);
  double on = 0;
  for (Eigen::Index t = 0; t < hull.mesh.F.rows(); ++t) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (int k = 0; k < 3; ++k) middle += hull.mesh.V.row(hull.mesh.F(t, k)).transpose() / 3;
    if (sections.value(middle) > -0.2 * hull.spacing) on += areas[t];
  }
  (hull.sections.from_top ? hull.sections.top_share : hull.sections.round_share) = on / areas.sum();
  hull.sections.box_share = 1 - on / areas.sum();
}

}  // namespace

void describe(OptionVisitor& v, HullOptions& o) {
  static constexpr std::array<std::string_view, 3> kSections{"auto", "box", "top"};
  v.value("triangles", o.triangles,
          {.doc = "number of triangles that the hull is aimed at", .min = 100, .max = 1e7});
  describe_choice(v, "sections", o.sections, kSections,
                  {.doc = "sections of the hull: decided by what is drawn, all that the views see, "
                          "or the top view's outline scaled to front and side"});
  v.value("ridges", o.ridges, {.doc = "whether edges of the mesh are flipped to run along ridges"});
}

VisualHull visual_hull(const Drawing& aligned, const HullOptions& options) {
  VisualHull hull;
  hull.views = outlined_views(aligned);
  if (hull.views.size() < 2)
    throw Error("has too few views for a hull", aligned.name, "two of front, side and top");
  const HullBox box = box_of(hull.views);
  if (!((box.high - box.low).minCoeff() > 0))
    throw Error("the views have no point in common", aligned.name);
  // The number of triangles goes with the inverse square of the spacing: one coarse mesh tells it.
  const double coarse = (box.high - box.low).norm() / 48;
  const SectionBounds sections(aligned, hull.views, options.sections);
  const QuadMesh trial = manifold_nets(hull.views, box, coarse, sections);
  hull.spacing =
      coarse * std::sqrt(2.0 * static_cast<double>(trial.quads.size()) / options.triangles);
  QuadMesh quads = manifold_nets(hull.views, box, hull.spacing, sections);
  fit_to_silhouettes(quads, hull.views, hull.spacing, sections);
  hull.mesh = split_quads(quads);
  // Several vertices of the nets may have gone to one corner.
  collapse_short_edges(hull.mesh, 0.01 * hull.spacing);
  if (options.ridges) flip_to_ridges(hull.mesh);
  place_on_silhouettes(hull);
  hull.sections = sections.report();
  measure_shares(hull, sections);
  return hull;
}

void place_on_silhouettes(VisualHull& hull) {
  hull.places.clear();
  for (const OutlinedView& view : hull.views)
    hull.places.push_back(places_on(view, hull.mesh.V, 0.02 * hull.spacing));
}

}  // namespace geoprior::sketch
