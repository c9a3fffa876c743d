#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "models/sketch/sections/view_slices.h"

namespace geoprior::sketch {

/// Exponents of a superellipse |u|^n + |v|^n = 1 by quadrant: (u > 0) + 2 (v > 0).
using QuadrantExponents = std::array<double, 4>;

/// Above this a superellipse counts as the box that it lies in.
constexpr double kBoxExponent = 32;

/// One part of the hull in a section: its widths in the two views that show the axis.
struct SectionPart {
  Slice p, q;            ///< in the first and in the second of them, as its round section has them
  Slice p_seen, q_seen;  ///< as the views have them: wider where one of them hides the part
  bool hidden = false;   ///< one view does not show its width: it is taken as circular
  double round = 0;      ///< 1: round, 0: the box of the widths, between them on the way there
  int tube = -1;         ///< whose exponents it has
};

/// All parts of a section at one place along the axis.
struct TubeSection {
  std::vector<SectionPart> parts;
  std::vector<QuadrantExponents> exponents;  ///< of the tubes

  /// Below 0 inside of the round part nearest to (p, q); near its outline about the distance.
  /// Minus infinity where that part is not round.
  [[nodiscard]] double value(double p, double q) const;
  /// Whether a width of that part is a guess, since no view shows it.
  [[nodiscard]] bool is_guessed(double p, double q) const;

 private:
  [[nodiscard]] const SectionPart* nearest(double p, double q) const;
};

/// Round sections across one axis of space, of the tubes that end in drawn rims.
///
/// A tube begins at a rim and goes on along the axis as long as its widths do not grow by more than
/// 2.25 a unit of way on either side (66 degrees; a shaft that becomes a foot, a neck that becomes
/// shoulders, a sleeve that meets the body); it may grow narrower at any rate, close, or part into
/// branches. Its sections are superellipses in the widths that its two views have there. Where it
/// ends at something else, the exponent grows without bound within a quarter of its width, so that
/// no ledge is left.
///
/// Of a branch that is narrower than 0.6 of the widest one the other view shows no width, since the
/// widest hides it; neither does a view that is missing. It gets that of a circular tube, the
/// branch's own width times the cosine of its tilt, within what the views leave.
///
/// Sections are half a percent larger than the widths, so that the views' silhouettes cut them and
/// lie on the hull in strips, exactly. The exponent is 2, but that a view from the end of the axis,
/// where there is one, must see all of its silhouette filled: exponents grow, quadrant by quadrant,
/// until it is, up to the box.
class TubeSections {
 public:
  /// @param rims  those of this axis count; at least one
  TubeSections(const std::vector<OutlinedView>& views, const std::vector<Rim>& rims, int axis);

  [[nodiscard]] int axis() const { return axis_; }
  [[nodiscard]] int first_across() const { return first_.across(); }
  [[nodiscard]] int second_across() const { return second_axis_; }
  [[nodiscard]] TubeSection at(double along) const;
  /// As TubeSection::value, at a point of space.
  [[nodiscard]] double value(const Eigen::Vector3d& x) const;
  [[nodiscard]] bool is_guessed(const Eigen::Vector3d& x) const;
  /// Its change, by differences over a step; 0 along axes on which it is not finite.
  [[nodiscard]] Eigen::Vector3d gradient(const Eigen::Vector3d& x, double step) const;
  /// Exponents of the tubes; tubes of several rims are one.
  [[nodiscard]] const std::vector<QuadrantExponents>& exponents() const { return exponents_; }
  /// Whether a view from the end of the axis was there to bound them.
  [[nodiscard]] bool seen_from_end() const { return end_.has_value(); }
  /// Number of tubes, once those of the same parts are counted as one.
  [[nodiscard]] int tubes() const;

 private:
  struct Node {
    int at = 0, part = 0;
  };
  /// Where a slanted rim of the other view cuts the tube: from its place farther in to the
  /// outermost.
  struct CutEnd {
    double inner = 0, outer = 0;
  };
  [[nodiscard]] std::vector<CutEnd> cuts_of_others(const std::vector<OutlinedView>& views,
                                                   const std::vector<Rim>& rims, int view) const;
  static const OutlinedView& showing(const std::vector<OutlinedView>& views, int axis, int nth);

  [[nodiscard]] std::vector<SectionPart> parts_at(double along) const;
  [[nodiscard]] Slice widest_from_end(double p) const;
  [[nodiscard]] const SectionPart* part_like(const SectionPart& part, int sample) const;
  [[nodiscard]] bool widens(const std::vector<Node>& path, const SectionPart& next) const;
  void track(const Rim& rim, int tube);
  [[nodiscard]] std::optional<Node> start_of(const Rim& rim) const;
  void mark(const std::vector<Node>& path, bool is_stopped, int tube);
  void fill_end_view();
  void fill(const Eigen::Vector2d& seen);

  int axis_ = 1;
  ViewSlices first_;
  std::optional<ViewSlices> second_;  ///< none: no second view shows the axis
  /// Of each of both: there it shows the cut, not the tube, whose width is that farther in.
  std::vector<CutEnd> first_cuts_, second_cuts_;
  std::optional<ViewSlices> end_;  ///< of the view along the axis, across the first's slices
  const OutlinedView* end_view_ = nullptr;
  int second_axis_ = 2;
  double start_ = 0, step_ = 1;                    ///< of the samples (m)
  std::vector<std::vector<SectionPart>> samples_;  ///< parts at start + (i + 1/2) step
  std::vector<QuadrantExponents> exponents_;
};

}  // namespace geoprior::sketch
