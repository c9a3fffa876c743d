#include "testbed/view/figure/colors.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <vector>

#include "core/error.h"
#include "testbed/joined.h"
#include "testbed/runner/number_text.h"

namespace geoprior {
namespace {

using Color = std::array<double, 3>;

// Pale skin to dark violet at even steps of lightness, after the "rocket" map of seaborn (Waskom
// 2021) reversed: zero is near white, so that the shading of an unaffected surface stays visible.
constexpr std::array<Color, 7> kSequential{{{0.960, 0.925, 0.890},
                                            {0.965, 0.780, 0.640},
                                            {0.957, 0.580, 0.404},
                                            {0.930, 0.335, 0.250},
                                            {0.763, 0.120, 0.295},
                                            {0.495, 0.115, 0.345},
                                            {0.230, 0.100, 0.240}}};

// Moreland's cool-warm at nine even steps.
constexpr std::array<Color, 9> kDiverging{{{0.230, 0.299, 0.754},
                                           {0.384, 0.510, 0.918},
                                           {0.554, 0.690, 0.996},
                                           {0.721, 0.817, 0.977},
                                           {0.865, 0.865, 0.865},
                                           {0.957, 0.768, 0.677},
                                           {0.957, 0.603, 0.482},
                                           {0.869, 0.378, 0.301},
                                           {0.706, 0.016, 0.150}}};

/// Range of a number without a unit, as a stretch, below which colours would tell roundings.
constexpr double kLeastShare = 1e-4;

/// Of lines of the first class, which would not be seen on the page in the tone of the material.
constexpr Color kInk{0.2, 0.2, 0.2};

// Pale grounds that keep their shading, after the hues of Okabe and Ito (2008); the last four as
// far from them and from each other as they are.
constexpr std::array<Color, 12> kClasses{{{0.900, 0.880, 0.830},
                                          {0.420, 0.650, 0.850},
                                          {0.945, 0.640, 0.240},
                                          {0.360, 0.720, 0.560},
                                          {0.820, 0.520, 0.690},
                                          {0.930, 0.860, 0.350},
                                          {0.850, 0.430, 0.300},
                                          {0.450, 0.450, 0.500},
                                          {0.270, 0.280, 0.660},
                                          {0.470, 0.270, 0.170},
                                          {0.720, 0.360, 0.880},
                                          {0.620, 0.880, 0.900}}};

// The first as water.cpp shades a surface seen from above; the others far from it.
constexpr std::array<Color, 7> kOnWater{{{0.215, 0.480, 0.560},
                                         {0.985, 0.850, 0.260},
                                         {0.945, 0.440, 0.180},
                                         {0.830, 0.450, 0.700},
                                         {0.500, 0.840, 0.480},
                                         {0.960, 0.930, 0.860},
                                         {0.560, 0.330, 0.760}}};
static_assert(kIdentityColors < kOnWater.size() && kIdentityColors < kClasses.size());

Color interpolate(std::span<const Color> map, double t) {
  const double position = std::clamp(t, 0.0, 1.0) * static_cast<double>(map.size() - 1);
  const auto index = std::min(static_cast<std::size_t>(position), map.size() - 2);
  const double f = position - static_cast<double>(index);
  Color out{};
  for (std::size_t c = 0; c < 3; ++c) out[c] = (1 - f) * map[index][c] + f * map[index + 1][c];
  return out;
}

std::vector<double> finite_values(const std::vector<const Part*>& parts, const std::string& name,
                                  std::string& unit) {
  std::vector<double> values;
  for (const Part* part : parts) {
    const NamedArray* array = part->find_array(name);
    if (array == nullptr) continue;
    unit = array->unit;
    for (const double x : scalars(*array)) {
      if (std::isfinite(x)) values.push_back(x);
    }
  }
  return values;
}

std::string array_names(const std::vector<const Part*>& parts) {
  std::set<std::string> names;
  for (const Part* part : parts) {
    for (const NamedArray& array : part->arrays) names.insert(array.name);
  }
  return names.empty() ? "this part has no arrays; leave color_by out" : joined(names);
}

double percentile(std::vector<double>& values, double fraction) {
  const auto index =
      static_cast<std::ptrdiff_t>(std::lround(fraction * static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[index];
}

}  // namespace

Color color_at(double t, bool diverging) {
  return diverging ? interpolate(kDiverging, t) : interpolate(kSequential, t);
}

Rgb to_rgb(const std::array<double, 3>& color) {
  Rgb out{};
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(color[c], 0.0, 1.0)));
  }
  return out;
}

Palette class_palette(std::size_t count, bool on_water, bool of_lines) {
  Palette palette;
  for (std::size_t i = 0; i < count; ++i) {
    palette.push_back(on_water ? kOnWater[i % kOnWater.size()] : kClasses[i % kClasses.size()]);
  }
  if (of_lines && count > 0) palette.front() = kInk;
  return palette;
}

Eigen::VectorXd scalars(const NamedArray& array) {
  return array.values.cols() == 1 ? Eigen::VectorXd(array.values.col(0))
                                  : Eigen::VectorXd(array.values.rowwise().norm());
}

ColorScale make_color_scale(const std::vector<const Part*>& parts, const std::string& name) {
  ColorScale scale;
  scale.array = name;
  std::vector<double> values = finite_values(parts, name, scale.unit);
  if (values.empty()) {
    throw Error("no array '" + name + "' with finite values", "figure_view.color_by",
                array_names(parts));
  }
  const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
  const double lowest = *least;
  const double highest = *greatest;
  scale.low = percentile(values, 0.005);
  scale.high = percentile(values, 0.995);
  const bool is_ratio = name.ends_with("ratio");
  const double center = is_ratio ? 1 : 0;
  if (is_ratio || (scale.low < 0 && scale.high > 0)) {
    scale.diverging = true;
    const double reach = std::max(scale.high - center, center - scale.low);
    scale.low = center - reach;
    scale.high = center + reach;
  }
  if (scale.unit == "1" && scale.high - scale.low < kLeastShare) {
    if (scale.diverging) scale.low = center - kLeastShare / 2;
    scale.high = scale.low + kLeastShare;
  }
  if (!(scale.high > scale.low)) {  // a constant array still needs a bar
    const double pad = std::max(std::abs(scale.low), 1.0) * 1e-3;
    scale.low -= pad;
    scale.high += pad;
  }
  scale.below = lowest < scale.low;
  scale.above = highest > scale.high;
  return scale;
}

ColorScale make_class_scale(const std::vector<const Part*>& parts, const std::string& name,
                            const std::vector<std::string>& classes, bool on_water) {
  ColorScale scale;
  scale.array = name;
  scale.classes = classes;
  const bool of_lines = std::all_of(
      parts.begin(), parts.end(), [](const Part* part) { return part->kind == Part::Kind::lines; });
  scale.palette = class_palette(classes.size(), on_water, of_lines);
  scale.low = -0.5;
  scale.high = static_cast<double>(classes.size()) - 0.5;
  std::string unit;
  for (const double x : finite_values(parts, name, unit)) {
    if (x == std::floor(x) && x > scale.low && x < scale.high) continue;
    throw Error("the array '" + name + "' has the value " + rounded_text(x), "figure_view.classes",
                "0 to " + std::to_string(classes.size() - 1));
  }
  return scale;
}

ColorScale make_identity_scale(const std::vector<const Part*>& parts, const std::string& name,
                               bool on_water) {
  constexpr double kMost = 1e6;
  std::string unit;
  double most = 0;
  for (const double x : finite_values(parts, name, unit)) {
    if (x != std::floor(x) || x < 0 || x > kMost) {
      throw Error("the array '" + name + "' has the value " + rounded_text(x),
                  "figure_view.identities", "integers from 0 on");
    }
    most = std::max(most, x);
  }
  ColorScale scale;
  scale.array = name;
  const Palette cycle = class_palette(kIdentityColors + 1, on_water);
  scale.palette.push_back(cycle.front());
  for (std::size_t i = 1; static_cast<double>(i) <= most; ++i) {
    scale.palette.push_back(cycle[1 + (i - 1) % kIdentityColors]);
  }
  scale.low = -0.5;
  scale.high = static_cast<double>(scale.palette.size()) - 0.5;
  return scale;
}

}  // namespace geoprior
