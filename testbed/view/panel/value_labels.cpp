#include "testbed/view/panel/value_labels.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "testbed/view/figure/cells.h"
#include "testbed/view/panel/plane_curves.h"

namespace geoprior {
namespace {

// Pixels of a picture that is shown at half its size.
constexpr int kLargest = 24;  ///< size of the letters
constexpr int kSmallest = 13;
constexpr int kBorder = 6;          ///< between a text and the border of the panel
constexpr int kToLine = 6;          ///< between a text and its line
constexpr int kClear = 22;          ///< between a column and what the window shows
constexpr double kMostShare = 0.3;  ///< of the panel's width, a column
constexpr double kLineSpacing = 1.3;
constexpr double kLeaderThickness = 1.5;
constexpr double kDotRadius = 3.2;
constexpr double kHalo = 2;
constexpr double kHaloOpacity = 0.75;
constexpr Rgb kTextColor{30, 30, 30};
constexpr Rgb kLeaderColor{80, 80, 86};
constexpr Rgb kWhite{255, 255, 255};

TextStyle letters(int size_px) { return {size_px, kTextColor, false, false}; }

int widest_label(const std::vector<std::string>& names, int size_px) {
  int most = 0;
  for (const std::string& name : names)
    most = std::max(most, text_width(display_name(name), letters(size_px)));
  return most;
}

/// The largest size at which all names fit the column.
int fitting_size(const LabelColumns& columns, int width_px) {
  const double room = columns.share * width_px - kBorder - kToLine;
  int size = kLargest;
  while (size > kSmallest && widest_label(columns.names, size) > room) --size;
  return size;
}

/// The text, or as much of its beginning as fits, and an ellipsis.
std::string shortened_label(std::string text, const TextStyle& style, double room) {
  if (text_width(text, style) <= room) return text;
  const auto is_continuation = [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
  };
  while (!text.empty() && text_width(text + "\u2026", style) > room) {
    while (text.size() > 1 && is_continuation(text.back())) text.pop_back();
    text.pop_back();
  }
  return text + "\u2026";
}

/// Heights nearest to the wanted ones (least squares) that are in order and `line` apart, from
/// `low` to `high`: with the spacing taken off, an isotonic regression (pool adjacent violators).
/// @param wanted  ascending
std::vector<double> spread_heights(const std::vector<double>& wanted, double line, double low,
                                   double high) {
  struct Pool {
    double sum;
    int count;
    [[nodiscard]] double mean() const { return sum / count; }
  };
  std::vector<Pool> pools;
  for (int i = 0; i < std::ssize(wanted); ++i) {
    pools.push_back({wanted[i] - line * i, 1});
    while (pools.size() > 1 && pools[pools.size() - 2].mean() >= pools.back().mean()) {
      const Pool last = pools.back();
      pools.pop_back();
      pools.back().sum += last.sum;
      pools.back().count += last.count;
    }
  }
  std::vector<double> heights;
  const double highest = high - line * (static_cast<double>(wanted.size()) - 1);
  for (const Pool& pool : pools) {
    for (int i = 0; i < pool.count; ++i) {
      const double base = std::max(low, std::min(pool.mean(), highest));
      heights.push_back(base + line * static_cast<double>(heights.size()));
    }
  }
  return heights;
}

/// Whether the lines from (x, y) of two labels to their things cross.
bool lines_cross(const PlacedLabel& a, const PlacedLabel& b, double x) {
  const auto side = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                       const Eigen::Vector2d& p) {
    return (to - from).x() * (p - from).y() - (to - from).y() * (p - from).x();
  };
  const Eigen::Vector2d from_a(x, a.y), from_b(x, b.y);
  return side(from_a, a.thing, from_b) * side(from_a, a.thing, b.thing) < 0 &&
         side(from_b, b.thing, from_a) * side(from_b, b.thing, a.thing) < 0;
}

/// Two labels whose lines cross change places, which makes their lines shorter: it comes to an end.
void uncross(std::vector<PlacedLabel>& column, double x) {
  bool changed = true;
  for (int round = 0; changed && round < 100; ++round) {
    changed = false;
    for (std::size_t i = 0; i < column.size(); ++i) {
      for (std::size_t j = i + 1; j < column.size(); ++j) {
        if (!lines_cross(column[i], column[j], x)) continue;
        std::swap(column[i].y, column[j].y);
        changed = true;
      }
    }
  }
}

using Sides = std::array<std::vector<PlacedLabel>, 2>;  // left, right

/// No column has more than `most`: those whose things are nearest to the middle go to the other
/// one, and of what neither holds the least seen are left out.
void balance_sides(Sides& columns, std::size_t most, double middle) {
  const auto is_smaller = [](const PlacedLabel& a, const PlacedLabel& b) {
    return a.size < b.size;
  };
  while (columns[0].size() + columns[1].size() > 2 * most) {
    auto& fuller = columns[columns[0].size() > columns[1].size() ? 0 : 1];
    fuller.erase(std::min_element(fuller.begin(), fuller.end(), is_smaller));
  }
  const auto is_nearer = [&](const PlacedLabel& a, const PlacedLabel& b) {
    return std::abs(a.thing.x() - middle) < std::abs(b.thing.x() - middle);
  };
  for (std::size_t side = 0; side < 2; ++side) {
    while (columns[side].size() > most) {
      const auto moved = std::min_element(columns[side].begin(), columns[side].end(), is_nearer);
      moved->right = side == 0;
      columns[1 - side].push_back(*moved);
      columns[side].erase(moved);
    }
  }
}

void draw_leader(Picture& picture, const PlacedLabel& label, double x, double thickness,
                 double radius, Rgb color) {
  stroke(picture, {{{x, label.y}, label.thing}}, thickness, color);
  fill_disc(picture, label.thing, radius, color);
}

void draw_label(Picture& picture, const PlacedLabel& label, double x, const TextStyle& style) {
  const int length = text_width(label.text, style);
  const int left = static_cast<int>(label.right ? x + kToLine : x - kToLine - length);
  const int middle = static_cast<int>(std::lround(label.y)), half = style.size_px * 6 / 10;
  for (int v = middle - half; v <= middle + half; ++v) {
    for (int u = left - 2; u < left + length + 2; ++u) picture.blend(u, v, kWhite, kHaloOpacity);
  }
  draw_text(picture, label.text, left, middle + style.size_px * 36 / 100, Align::left, style);
}

}  // namespace

LabelColumns make_label_columns(const std::string& array, std::vector<std::string> names,
                                int most_width_px, int most_height_px, ViewWindow& window) {
  LabelColumns columns{array, std::move(names), 0};
  const double column =
      std::min(1.0 * widest_label(columns.names, kLargest) + kBorder + kToLine + kClear,
               kMostShare * most_width_px);
  const double content =
      std::min(most_width_px - 2 * column, most_height_px * window.width_m / window.height_m);
  const double width = content + 2 * column;
  columns.share = (column - kClear) / width;
  window.width_m *= width / content;
  return columns;
}

std::vector<PlacedLabel> place_labels(const std::vector<SeenName>& seen, int width_px,
                                      int height_px, double column_px, double line_height) {
  Sides columns;
  for (const SeenName& one : seen) {
    const bool right = one.at.x() >= width_px / 2.0;
    columns[right ? 1 : 0].push_back({display_name(one.name), one.at, right, 0, one.pixels});
  }
  const double low = line_height / 2 + 1, high = height_px - line_height / 2 - 1;
  const auto most = static_cast<std::size_t>(std::max(0.0, (high - low) / line_height + 1));
  balance_sides(columns, most, width_px / 2.0);
  std::vector<PlacedLabel> placed;
  for (std::vector<PlacedLabel>& column : columns) {
    std::stable_sort(column.begin(), column.end(), [](const PlacedLabel& a, const PlacedLabel& b) {
      return a.thing.y() < b.thing.y();
    });
    std::vector<double> wanted;
    for (const PlacedLabel& label : column) wanted.push_back(label.thing.y());
    const std::vector<double> heights = spread_heights(wanted, line_height, low, high);
    for (std::size_t i = 0; i < column.size(); ++i) column[i].y = heights[i];
    if (!column.empty()) uncross(column, column.front().right ? width_px - column_px : column_px);
    placed.insert(placed.end(), column.begin(), column.end());
  }
  return placed;
}

void draw_value_labels(Picture& picture, const std::vector<SeenName>& seen,
                       const LabelColumns& columns) {
  const TextStyle style = letters(fitting_size(columns, picture.width));
  const double room =
      std::min(1.0 * widest_label(columns.names, style.size_px), 0.45 * picture.width);
  const double column = kBorder + room + kToLine;
  std::vector<PlacedLabel> labels =
      place_labels(seen, picture.width, picture.height, column, kLineSpacing * style.size_px);
  const auto line_begin = [&](const PlacedLabel& label) {
    return label.right ? picture.width - column : column;
  };
  for (const PlacedLabel& label : labels) {
    draw_leader(picture, label, line_begin(label), kLeaderThickness + 2 * kHalo, kDotRadius + kHalo,
                kWhite);
  }
  for (const PlacedLabel& label : labels)
    draw_leader(picture, label, line_begin(label), kLeaderThickness, kDotRadius, kLeaderColor);
  for (PlacedLabel& label : labels) {
    label.text = shortened_label(label.text, style, room);
    draw_label(picture, label, line_begin(label), style);
  }
}

}  // namespace geoprior
