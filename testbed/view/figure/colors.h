#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "testbed/view/figure/picture.h"

namespace geoprior {

/// Colour (0 … 1 a channel) at t in 0 … 1 of a map even in lightness: pale to dark for magnitudes,
/// a cool-warm diverging map (Moreland 2009) for signed quantities.
std::array<double, 3> color_at(double t, bool diverging);

/// 8 bits a channel.
Rgb to_rgb(const std::array<double, 3>& color);

using Palette = std::vector<std::array<double, 3>>;

/// Colours of classes: told apart by people who see no red or no green, in print, and under
/// shading. Twelve (seven on water), then the first again.
/// @param on_water  the first class is plain water, and the others stand out from it
/// @param of_lines  they are drawn on the page: the first class is ink
Palette class_palette(std::size_t count, bool on_water, bool of_lines = false);

/// One mapping from values to colours, shared by every panel of a picture.
struct ColorScale {
  std::string array;
  std::vector<std::string> classes;  ///< names of the integers 0, 1, …, where they have any
  Palette palette;                   ///< of the integers 0, 1, …; empty: a scale of numbers
  std::string unit;
  double low = 0;
  double high = 1;
  bool diverging = false;
  bool below = false;  ///< some values lie under `low` and take its colour
  bool above = false;
};

/// One number an element: the value, or the length of a vector.
Eigen::VectorXd scalars(const NamedArray& array);

/// Range of the values of all parts drawn: 0.5 … 99.5 percentiles, so that a few extreme elements
/// do not take all the colours; symmetric about 0 (signed values) or 1 (ratios); of numbers without
/// a unit at least 1e-4 wide, so that roundings have no colours.
/// @throws Error  when no part has the array, listing the arrays there are
ColorScale make_color_scale(const std::vector<const Part*>& parts, const std::string& name);

/// The scale of an array of integers; no part need have it.
/// @throws Error  when a value is none of 0, 1, … classes - 1
ColorScale make_class_scale(const std::vector<const Part*>& parts, const std::string& name,
                            const std::vector<std::string>& classes, bool on_water = false);

/// The scale of an array of integers that tell things apart (tracks, features): 0 is none, and the
/// others take the colours of a palette in turn, so that two may share one.
/// @throws Error  when a value is no integer from 0 on
ColorScale make_identity_scale(const std::vector<const Part*>& parts, const std::string& name,
                               bool on_water);

/// How many things in turn have different colours in an identity scale.
inline constexpr std::size_t kIdentityColors = 6;

}  // namespace geoprior
