#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "testbed/view/figure/picture.h"

namespace geoprior {

/// A piece of a curve in a plane (x to the right, y up). What a curve encloses is on its left.
struct CurveSegment {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
};

/// How a plane lies on a picture: `center` is in its middle.
struct PlaneView {
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double pixels_per_metre = 1;
};

/// A point of the plane in pixels: x to the right, y downwards from the top left corner.
Eigen::Vector2d to_pixels(const Eigen::Vector2d& point, const PlaneView& view,
                          const Picture& picture);
std::vector<CurveSegment> to_pixels(const std::vector<CurveSegment>& segments,
                                    const PlaneView& view, const Picture& picture);

/// Winding number of the curves about a point: 0 outside, 1 inside, 2 where what they enclose
/// overlaps itself, negative where it is inside out.
int winding_number(const std::vector<CurveSegment>& segments, const Eigen::Vector2d& point);

/// Paints what the curves enclose by its winding number. A line of the picture on which they are
/// open stays as it is.
/// @param pixels  segments in pixels
void fill(Picture& picture, const std::vector<CurveSegment>& pixels,
          const std::function<Rgb(int winding)>& color);

/// Draws the curves with round ends. Where segments meet, the line is no darker.
/// @param pixels     segments in pixels
/// @param thickness  pixels
void stroke(Picture& picture, const std::vector<CurveSegment>& pixels, double thickness, Rgb color,
            double opacity = 1);

/// Pieces of a poly-line, `dash` long and `gap` apart; the line begins with one.
std::vector<CurveSegment> dashes(const std::vector<Eigen::Vector2d>& line, double dash, double gap);

/// @param center, radius  pixels
void fill_disc(Picture& picture, const Eigen::Vector2d& center, double radius, Rgb color);

}  // namespace geoprior
