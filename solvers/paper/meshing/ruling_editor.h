#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/paper/sheet/pattern.h"
#include "solvers/paper/sheet/structure.h"

namespace geoprior::paper {

/// What a candidate ruling runs into (thesis 3.2.1, Figure 3.9).
struct RulingHit {
  enum class Kind { border, ruling, singular };
  Kind kind = Kind::border;
  Eigen::Vector2d point;
  double distance = 0;  ///< from where it started (m)
  int index = -1;       ///< edge of the border, ruling, or singular point
};

/// Adds rulings to a structure so that they stay apart (border: that of the sheet, a hole's or a
/// cut's): no two cross, none passes another's end, an anchor or a singular point at less than
/// `gap`, ends nearer than `gap` to a corner, an anchor or another end on the border snap to it,
/// and rulings that share an end differ by `least_angle`.
///
/// These bounds are what keeps the triangles of the mesh from degenerating: their altitude is about
/// `gap` or more.
class RulingEditor {
 public:
  struct Bounds {
    double gap = 4e-3;         ///< m
    double least_angle = 0.1;  ///< rad
  };
  /// @param anchors  pattern points that are vertices of every mesh (handles)
  RulingEditor(const Pattern& pattern, const std::vector<Eigen::Vector2d>& anchors,
               const Bounds& bounds, PaperStructure& structure);

  /// First thing that a candidate from `origin` meets: a singular point within the gap, a ruling,
  /// or the border. Rulings that end in `from_singular` are passed over.
  [[nodiscard]] RulingHit propagate(const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                                    std::optional<int> from_singular = {}) const;
  /// Middles of the parts of the line through p that lie in the pattern.
  [[nodiscard]] std::vector<Eigen::Vector2d> middles_of_parts(const Eigen::Vector2d& p,
                                                              const Eigen::Vector2d& d) const;
  [[nodiscard]] bool is_hole(const RulingHit& hit) const {
    return hit.kind == RulingHit::Kind::border && hit.index >= std::ssize(pattern_.border);
  }
  /// True when the ruling keeps all bounds, rulings marked in `ignored` aside.
  [[nodiscard]] bool fits(const Ruling& ruling, const std::vector<bool>& ignored = {}) const;

  /// The line through `centre` from border to border, ends snapped, moved onto an anchor within the
  /// gap, and turned by up to ten degrees into a row of anchors that leaves no other; absent when
  /// it meets anything else or does not fit.
  [[nodiscard]] std::optional<Ruling> chord(const Eigen::Vector2d& centre,
                                            const Eigen::Vector2d& direction,
                                            const std::vector<bool>& ignored = {}) const;
  /// A ruling from border to border turned about its middle, ends where they fall; absent when it
  /// does not fit among the others.
  [[nodiscard]] std::optional<Ruling> turned(int ruling, double angle) const;
  /// The line from a singular point to the border, under the same conditions as `chord`.
  [[nodiscard]] std::optional<Ruling> ray(int singular_point,
                                          const Eigen::Vector2d& direction) const;
  /// The line from a singular point to a border point or to another singular point.
  [[nodiscard]] std::optional<Ruling> ray_to(int singular_point, const Eigen::Vector2d& end) const;
  [[nodiscard]] std::optional<Ruling> ray_between(int singular_point, int other) const;

  void add(const Ruling& ruling) { structure_.rulings.push_back(ruling); }
  /// Removes the marked rulings, the others keep their order.
  void remove(const std::vector<bool>& marked);
  /// Removes a singular point and the rulings that end in it.
  void remove_point(int singular_point);

  /// Nearest, if nearer than `within`, of the corners and the anchors on the border and of where
  /// rulings and singular points touch it.
  [[nodiscard]] std::optional<Eigen::Vector2d> node_near(const Eigen::Vector2d& p,
                                                         double within) const;
  [[nodiscard]] const Bounds& bounds() const { return bounds_; }
  [[nodiscard]] const Pattern& pattern() const { return pattern_; }
  [[nodiscard]] const std::vector<Eigen::Vector2d>& anchors() const { return anchors_; }
  [[nodiscard]] PaperStructure& structure() const { return structure_; }
  /// Points nearer than this are one (m).
  [[nodiscard]] double same() const { return same_; }

 private:
  [[nodiscard]] bool clear_of_points(const Ruling& ruling) const;
  [[nodiscard]] bool clear_of(const Ruling& ruling, const Ruling& other) const;
  [[nodiscard]] std::optional<Eigen::Vector2d> border_end(const Eigen::Vector2d& centre,
                                                          const Eigen::Vector2d& direction,
                                                          bool snap,
                                                          const std::vector<bool>& ignored) const;
  [[nodiscard]] Eigen::Vector2d snapped(const Eigen::Vector2d& border_point) const;

  const Pattern& pattern_;
  std::vector<Eigen::Vector2d> corners_;  ///< of the pattern
  const std::vector<Eigen::Vector2d>& anchors_;
  std::vector<Eigen::Vector2d> border_anchors_;  ///< of them
  Bounds bounds_;
  PaperStructure& structure_;
  double same_;
};

}  // namespace geoprior::paper
