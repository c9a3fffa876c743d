#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "models/sketch/drawing/outlined_view.h"
#include "models/sketch/sections/section_report.h"
#include "models/sketch/sections/top_sections.h"
#include "models/sketch/sections/tube_sections.h"
#include "models/sketch/surface/nets.h"

namespace geoprior::sketch {

/// What bounds the hull beside the silhouettes of its views: its sections.
///
/// The views of a round thing see a box's as well: nothing of a drawing from the front and from
/// the side says what is in the corners. `HullSections::automatic` decides it by what is drawn:
///
/// 1. Where there is a top view, its outline is the section at every height, scaled to the widths
///    of front and side, unless that contradicts the drawing (`TopSections::contradiction`).
/// 2. Else tubes that end in drawn borders are round (`TubeSections`), each across the axis of
///    space that its rim is most nearly orthogonal to; a view along that axis keeps its silhouette.
///    Where round sections leave more than a twentieth of a silhouette unfilled, they contradict
///    it.
/// 3. All else is a box, as far as the views let it.
///
/// It cannot: tell a box that is open at one end, drawn without its top view, from a tube
/// (`sections = "box"`), nor see that one side of a tube is flat and the other round.
class SectionBounds {
 public:
  /// @throws Error  on `top` without all three views
  SectionBounds(const Drawing& aligned, const std::vector<OutlinedView>& views,
                HullSections sections);

  [[nodiscard]] bool empty() const { return !top_ && tubes_.empty(); }
  /// Whether they are the top view's outline at every height.
  [[nodiscard]] bool from_top() const { return top_.has_value(); }
  /// Raises a function of a hull's grid to what the sections leave of it.
  void bound(GridFunction& f) const;
  /// A point near the outlines of sections, moved onto the outermost of them.
  /// @param step  at most so far (m)
  [[nodiscard]] Eigen::Vector3d moved_on(const Eigen::Vector3d& x, double step) const;
  /// Negative inside of all of them, near their outlines about the distance; minus infinity where
  /// there are none.
  [[nodiscard]] double value(const Eigen::Vector3d& x) const;
  [[nodiscard]] const SectionReport& report() const { return report_; }

 private:
  void bound_by_top(GridFunction& f) const;
  void bound_by_tubes(const TubeSections& tubes, GridFunction& f) const;
  /// Whether tubes guess a width at a point where those of another axis know it.
  [[nodiscard]] bool is_known_elsewhere(const TubeSections& tubes, const Eigen::Vector3d& x) const;

  std::optional<TopSections> top_;
  std::vector<TubeSections> tubes_;  ///< an axis each
  SectionReport report_;
};

}  // namespace geoprior::sketch
