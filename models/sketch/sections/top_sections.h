#pragma once

#include <Eigen/Core>
#include <vector>

#include "models/sketch/sections/view_slices.h"

namespace geoprior::sketch {

/// The outline of the top view, scaled at every height to the widths of the views from the front
/// and from the side, and a fifth of a percent larger, so that the silhouettes of all views cut
/// them and lie on the hull in strips. Right is x in front and top; it is -z from the side, which
/// is up in the top view.
class TopSections {
 public:
  /// @throws Error  without all three views
  TopSections(const std::vector<OutlinedView>& views, const std::vector<Rim>& rims);

  /// Moves what is asked at one height into the top view and back.
  struct AtHeight {
    Eigen::Vector2d low, scale;
  };
  [[nodiscard]] AtHeight at(double y) const;
  /// Not a distance in space, but linear across a cell near the surface, which is all that surface
  /// nets ask of it.
  /// @param q  x, -z
  [[nodiscard]] double distance(const AtHeight& at, const Eigen::Vector2d& q) const;
  /// The point moved, at its height, onto the section's outline.
  [[nodiscard]] Eigen::Vector3d moved_on(const Eigen::Vector3d& x) const;

  /// Empty where sections of the top view's outline are what the views ask for; else why not:
  /// several parts in one section, a section far off the middle of the top view's box, or some of
  /// the top view's silhouette that no section fills.
  [[nodiscard]] std::string contradiction() const;

 private:
  [[nodiscard]] bool fills_top_view() const;

  Outline top_;
  ViewSlices front_, side_;
};

}  // namespace geoprior::sketch
