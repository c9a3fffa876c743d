#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace geoprior::paper {

/// The flat shape that a sheet is cut from: a simple polygon in the plane, counter-clockwise,
/// metres, and the holes in it, simple polygons that run clockwise: the material is on the left of
/// every edge. Every sheet is an isometric image of its pattern, or should be.
///
/// Its loops are the border and the holes, in this order. Corners and edges are numbered through
/// all loops; edge i leads from corner i to the next corner of its loop.
///
/// Along its cuts, open polylines in the ground, the sheet is separated: both lips are the same
/// points of the plane, so that area and ground stay, but nothing that crosses a cut holds
/// together. An end of a cut lies on the border or another cut, or it is a tip. The edges of cuts
/// are numbered after those of the loops, in order.
struct Pattern {
  std::vector<Eigen::Vector2d> border;
  std::vector<std::vector<Eigen::Vector2d>> holes = {};
  std::vector<std::vector<Eigen::Vector2d>> cuts = {};

  [[nodiscard]] std::size_t loop_count() const { return 1 + holes.size(); }
  [[nodiscard]] const std::vector<Eigen::Vector2d>& loop(std::size_t i) const {
    return i == 0 ? border : holes[i - 1];
  }
};

/// Most corners of a pattern: every pair of edges is looked at.
inline constexpr int kMostCorners = 10000;

/// Calls `visit(a, b)` for the edges from a to b of all loops, in the order of their numbers.
template <class Visit>
void each_loop_edge(const Pattern& pattern, Visit&& visit) {
  for (std::size_t k = 0; k < pattern.loop_count(); ++k) {
    const std::vector<Eigen::Vector2d>& loop = pattern.loop(k);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      visit(loop[i], loop[i + 1 == loop.size() ? 0 : i + 1]);
    }
  }
}

/// The same of all cuts.
template <class Visit>
void each_cut_edge(const Pattern& pattern, Visit&& visit) {
  for (const std::vector<Eigen::Vector2d>& cut : pattern.cuts) {
    for (std::size_t i = 0; i + 1 < cut.size(); ++i) visit(cut[i], cut[i + 1]);
  }
}

/// The same of all loops, then of all cuts.
template <class Visit>
void each_edge(const Pattern& pattern, Visit&& visit) {
  each_loop_edge(pattern, visit);
  each_cut_edge(pattern, visit);
}

/// Corners of all loops, in the order of their numbers.
std::vector<Eigen::Vector2d> corners(const Pattern& pattern);

/// Number of edges of loops and cuts.
int edge_count(const Pattern& pattern);

/// Number of the edge that follows one on its loop, which is that of the corner at its end.
int next_edge(const Pattern& pattern, int edge);

/// The axis-aligned box of the border, and with it of the pattern.
Eigen::AlignedBox2d bounding_box(const Pattern& pattern);

/// The same pattern with every loop the right way round.
Pattern oriented(Pattern pattern);

/// Axis-aligned rectangle centred at the origin.
Pattern rectangle_pattern(double width, double height);

/// Regular polygon with `corners` corners on the circle of this radius about the origin.
Pattern disc_pattern(double radius, int corners);

/// Throws Error naming hole, corner or edge unless every loop is finite, has three corners that are
/// not collinear, no corner twice, no spike, does not cross or touch itself and has some area; the
/// holes lie in the border and beside each other, and no two loops come nearer to each other than
/// a millionth of the pattern's width. `where` names its source (a file and key).
void require_simple_loops(const Pattern& pattern, const std::string& where);

/// The same, the border runs counter-clockwise, the holes clockwise, and the cuts lie in the ground
/// and meet nothing but with their ends, which may lie on the border, a hole or another cut.
void require_simple(const Pattern& pattern, const std::string& where);

/// Signed area (m^2), positive for a counter-clockwise border; holes are taken off.
double signed_area(const Pattern& pattern);

/// Longest distance of two corners (m).
double diameter(const Pattern& pattern);

/// Larger side of the bounding box (m): the "width" that tolerances refer to.
double width(const Pattern& pattern);

/// Shorter side of the rectangle that has the area and the outline's length of the pattern (m): of
/// a band, straight or not, its width. A quarter of the outline of what is rounder than a square.
double band_width(const Pattern& pattern);

/// True inside, and within `tolerance` (m) of border or hole: not in a hole.
bool contains(const Pattern& pattern, const Eigen::Vector2d& p, double tolerance = 0);

/// Point on the segment a b that lies outside the pattern by more than `tolerance` (m), the middle
/// of a stretch between two edges; absent when all of the segment lies in the pattern.
std::optional<Eigen::Vector2d> leaves_pattern(const Pattern& pattern, const Eigen::Vector2d& a,
                                              const Eigen::Vector2d& b, double tolerance);

/// Point of border, holes and cuts nearest to `p`, and where it lies; of equals that with the
/// lowest number.
struct BorderPoint {
  Eigen::Vector2d point;
  int edge = 0;  ///< its number
  double t = 0;  ///< 0 … 1 along that edge
  double distance = 0;
};
BorderPoint nearest_on_border(const Pattern& pattern, const Eigen::Vector2d& p);
/// The same of border and holes alone.
BorderPoint nearest_on_loops(const Pattern& pattern, const Eigen::Vector2d& p);

/// Distance of a point from the nearest cut (m); infinite without one.
double distance_to_cuts(const Pattern& pattern, const Eigen::Vector2d& p);

}  // namespace geoprior::paper
