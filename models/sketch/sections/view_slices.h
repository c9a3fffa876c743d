#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <string>
#include <vector>

#include "models/sketch/drawing/outlined_view.h"

namespace geoprior::sketch {

/// A drawn border that ends a tube: it runs along the silhouette from one side of a part to the
/// other.
struct Rim {
  std::string id;  ///< of the stroke
  int view = 0;    ///< among the hull's views
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d outward{0, 1};  ///< across its chord, out of the silhouette, unit
  int axis = 1;                   ///< of space, along which the tube is cut into sections
};

/// Where a line across a silhouette is inside of it, in coordinates of space.
struct Slice {
  double low = 0, high = 0;              ///< m
  double low_slope = 0, high_slope = 0;  ///< change of both along the axis

  [[nodiscard]] double width() const { return high - low; }
  [[nodiscard]] double middle() const { return 0.5 * (low + high); }
  /// Length that two slices share; negative: how far they are apart.
  [[nodiscard]] double overlap(const Slice& other) const {
    return std::min(high, other.high) - std::max(low, other.low);
  }
};

/// Lines across a silhouette, orthogonal to one axis of space: what lies inside of it at any place
/// along the axis, exactly.
///
/// Rims are not sides: stretches of the silhouette that are rims across this axis are left out, and
/// the sides that end there go on straight to the rim's outermost point. So a slanted or curved rim
/// cuts a tube without making it narrower.
class ViewSlices {
 public:
  /// @param view  a view that shows the axis
  /// @param rims  those of this view and axis count
  ViewSlices(const OutlinedView& view, int axis, const std::vector<Rim>& rims = {},
             int number_of_view = -1);

  /// From low to high; at the nearest end for places beyond the ends.
  [[nodiscard]] std::vector<Slice> at(double along) const;
  /// From the lowest to the highest of all of them.
  [[nodiscard]] Slice extent_at(double along) const;

  [[nodiscard]] int across() const { return across_; }  ///< axis of space that slices lie along
  [[nodiscard]] double first() const { return knots_.front(); }
  [[nodiscard]] double last() const { return knots_.back(); }

 private:
  struct Side {
    Eigen::Vector2d a, b;  ///< (along, across)
  };
  void add_sides(const std::vector<Eigen::Vector2d>& outline, const std::vector<int>& rim_of,
                 const std::vector<Rim>& rims);
  void sort_into_bands();

  int across_ = 0;
  std::vector<Side> sides_;
  std::vector<double> knots_;            ///< places along the axis between which no side ends
  std::vector<std::vector<int>> bands_;  ///< sides that pass from a knot to the next
};

/// Borders that end tubes, with the axes of these: the axis of space that the rim is most nearly
/// orthogonal to, unless other parts hide the tube's width there in the view or no second view
/// shows that axis. A bent rim is one that is seen obliquely: it counts where a straighter one says
/// so, in another view. A slit, a closed border, and one that follows a silhouette around are no
/// rims.
std::vector<Rim> rims_of(const Drawing& aligned, const std::vector<OutlinedView>& views);

}  // namespace geoprior::sketch
