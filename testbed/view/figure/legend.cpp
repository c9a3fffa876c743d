// What explains the colours of a figure: a scalar bar, or a legend of classes and overlays.

#include "testbed/view/figure/legend.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "testbed/view/figure/named_values.h"
#include "testbed/view/panel/plane_curves.h"

namespace geoprior {
namespace {

const TextStyle kStyle{26, {40, 40, 40}, false, false};

using Color = std::array<double, 3>;
constexpr std::array<Color, 3> kLines{{{0.13, 0.16, 0.26}, {0.55, 0.26, 0.10}, {0.10, 0.42, 0.36}}};
constexpr std::array<Color, 2> kSolids{{{0.80, 0.30, 0.20}, {0.93, 0.90, 0.84}}};
constexpr std::array<Color, 3> kPoints{
    {{0.82, 0.08, 0.08}, {0.10, 0.22, 0.62}, {0.42, 0.12, 0.52}}};
constexpr Color kPaper{0.80, 0.77, 0.71}, kFibre{0.50, 0.48, 0.45};

/// Steps of 1, 2 or 5 times a power of ten: about five of them.
double tick_step(double range) {
  const double raw = range / 5;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (raw <= factor * power * 1.0000001) return factor * power;
  }
  return 10 * power;
}

std::string tick_label(double value, double step) {
  std::array<char, 32> text{};
  if (std::abs(value) < 1e-9 * step) value = 0;
  std::snprintf(text.data(), text.size(), "%.6g", std::round(value / step) * step);
  return text.data();
}

/// The finest step whose labels do not touch on a bar of that length.
double fitting_tick_step(double low, double high, int length) {
  constexpr int kBetween = 20;
  for (double range = high - low;; range *= 2) {
    const double step = tick_step(range);
    // Labels of multiples of the step are longest at the ends or beside zero.
    const int width =
        std::max({text_width(tick_label(std::ceil(low / step) * step, step), kStyle),
                  text_width(tick_label(std::floor(high / step) * step, step), kStyle),
                  text_width(tick_label(low < 0 ? -step : step, step), kStyle)});
    if (step / (high - low) * length >= width + kBetween || range > 8 * (high - low)) return step;
  }
}

void draw_pointed_end(Picture& picture, int x, int y, int height, int sign, Rgb color) {
  const int length = height * 3 / 4;
  for (int i = 0; i < length; ++i) {
    const int half = height * (length - i) / (2 * length);
    picture.fill_rectangle(sign > 0 ? x + i : x - 1 - i, y + height / 2 - half, 1, 2 * half, color);
  }
}

constexpr int kMarkWidth = 44;
constexpr int kMarkHeight = 28;
constexpr int kMarkGap = 12;   ///< to its label
constexpr int kEntryGap = 48;  ///< to the next entry
constexpr int kLineHeight = 52;
constexpr int kSideMargin = 20;

int entry_width(const LegendEntry& entry) {
  if (entry.label.empty()) return kMarkWidth;
  return kMarkWidth + kMarkGap + text_width(entry.label, kStyle);
}

/// Marks without a label belong to the entry that follows.
int gap_after(const LegendEntry& entry) { return entry.label.empty() ? kMarkGap / 2 : kEntryGap; }

void draw_mark(Picture& picture, const LegendEntry& entry, int x, int top) {
  const Rgb color = to_rgb(entry.color);
  const int middle = top + kMarkHeight / 2;
  if (entry.mark == LegendEntry::Mark::area) {
    picture.fill_rectangle(x, top, kMarkWidth, kMarkHeight, {110, 110, 110});
    picture.fill_rectangle(x + 1, top + 1, kMarkWidth - 2, kMarkHeight - 2, color);
  } else if (entry.mark == LegendEntry::Mark::line) {
    picture.fill_rectangle(x, middle - 2, kMarkWidth, 4, color);
  } else if (entry.mark == LegendEntry::Mark::dashes) {
    const std::vector<Eigen::Vector2d> line{{x, middle}, {x + kMarkWidth, middle}};
    stroke(picture, dashes(line, 10, 7), 3, color);
  } else {
    fill_disc(picture, {x + kMarkWidth / 2 + 0.5, middle + 0.5}, 9, color);
  }
}

/// The first overlay of that name in any panel; null when no variant has it.
const NamedPart* find_overlay(const std::vector<FigureRow>& rows, const std::string& name) {
  for (const FigureRow& row : rows) {
    for (const FigureCell& cell : row.cells) {
      for (const NamedPart& overlay : cell.overlays) {
        if (overlay.name == name) return &overlay;
      }
    }
  }
  return nullptr;
}

LegendEntry::Mark mark_of(const Part& overlay) {
  switch (overlay.kind) {
    case Part::Kind::points:
      return LegendEntry::Mark::ball;
    case Part::Kind::triangles:
      return LegendEntry::Mark::area;
    default:
      return LegendEntry::Mark::line;
  }
}

/// "No track", and the colours that tracks take in turn.
std::vector<LegendEntry> identity_entries(const std::string& array, bool on_water) {
  std::vector<LegendEntry> entries;
  for (const auto& color : class_palette(kIdentityColors + 1, on_water)) {
    entries.push_back({"", color, LegendEntry::Mark::area});
  }
  entries.front().label = "No " + array;
  entries.back().label = "One colour a " + array;
  return entries;
}

/// Beside the bar, or centred above it where the picture is too narrow: the bar is then moved, and
/// its new top returned.
int draw_bar_title(Picture& picture, const ColorScale& scale, int length, int& left, int top,
                   int thickness) {
  constexpr int kGap = 40;
  constexpr int kMargin = 20;
  std::string title = display_name(scale.array);
  if (!scale.unit.empty() && scale.unit != "1") title += " [" + scale.unit + "]";
  if (text_width(title, kStyle) <= left - kGap - kMargin) {
    draw_text(picture, title, left - kGap, top + thickness - 4, Align::right, kStyle);
    return top;
  }
  TextStyle style = kStyle;
  while (style.size_px > 12 && text_width(title, style) > picture.width - 2 * kMargin) {
    --style.size_px;
  }
  draw_text(picture, title, picture.width / 2, top + thickness - 4, Align::center, style);
  left = (picture.width - length) / 2;
  return top + kGap;
}

}  // namespace

void draw_scalar_bar(Picture& picture, const ColorScale& scale, int top) {
  constexpr int kThickness = 28;
  const int length = std::min(1000, picture.width / 2);
  int left = (picture.width - length) / 2 + picture.width / 12;
  top = draw_bar_title(picture, scale, length, left, top, kThickness);
  for (int x = 0; x < length; ++x) {
    picture.fill_rectangle(left + x, top, 1, kThickness,
                           to_rgb(color_at((x + 0.5) / length, scale.diverging)));
  }
  if (scale.below) {
    draw_pointed_end(picture, left, top, kThickness, -1, to_rgb(color_at(0, scale.diverging)));
  }
  if (scale.above) {
    draw_pointed_end(picture, left + length, top, kThickness, 1,
                     to_rgb(color_at(1, scale.diverging)));
  }
  const double step = fitting_tick_step(scale.low, scale.high, length);
  for (double v = std::ceil(scale.low / step - 1e-9) * step; v <= scale.high + 1e-9 * step;
       v += step) {
    const int x =
        left + static_cast<int>(std::lround((v - scale.low) / (scale.high - scale.low) * length));
    picture.fill_rectangle(x - 1, top + kThickness, 2, 8, kStyle.color);
    draw_text(picture, tick_label(v, step), x, top + kThickness + 40, Align::center, kStyle);
  }
}

OverlayColors overlay_colors(const std::vector<FigureRow>& rows,
                             const std::vector<std::string>& overlays) {
  OverlayColors colors;
  std::size_t lines = 0;
  std::size_t points = 0;
  std::size_t solids = 0;
  for (const std::string& name : overlays) {
    const NamedPart* overlay = find_overlay(rows, name);
    if (overlay == nullptr) continue;
    if (name == kLipDetail || name == kFibres) {
      colors[name] = name == kFibres ? kFibre : kPaper;
      continue;
    }
    switch (overlay->part.kind) {
      case Part::Kind::points:
        colors[name] = kPoints[points++ % kPoints.size()];
        break;
      case Part::Kind::triangles:
        colors[name] = kSolids[solids++ % kSolids.size()];
        break;
      default:
        colors[name] = kLines[lines++ % kLines.size()];
    }
  }
  return colors;
}

std::vector<LegendEntry> legend_entries(const std::vector<FigureRow>& rows,
                                        const FigureView& view) {
  std::vector<LegendEntry> entries;
  if (view.classes.empty() && !view.identities) return entries;
  bool colored = false, of_lines = true;
  for (const FigureRow& row : rows) {
    for (const FigureCell& cell : row.cells) {
      if (!cell.part || cell.part->find_array(*view.color_by) == nullptr) continue;
      colored = true;
      of_lines = of_lines && cell.part->kind == Part::Kind::lines;
    }
  }
  const bool on_water = view.material == FigureView::Material::water;
  if (colored && view.identities) {
    entries = identity_entries(*view.color_by, on_water);
  } else if (colored) {
    const Palette palette = class_palette(view.classes.size(), on_water, of_lines);
    const std::vector<bool> occurs = codes_that_occur(rows, *view.color_by);
    for (std::size_t i = 0; i < view.classes.size(); ++i) {
      if (!occurs.empty() && (i >= occurs.size() || !occurs[i])) continue;
      entries.push_back({display_name(view.classes[i]), palette[i], LegendEntry::Mark::area});
    }
  }
  const OverlayColors colors = overlay_colors(rows, view.overlays);
  for (const std::string& name : view.overlays) {
    const NamedPart* overlay = find_overlay(rows, name);
    if (overlay == nullptr) continue;
    entries.push_back({display_name(name), colors.at(name), mark_of(overlay->part)});
  }
  if (view.expected) {
    entries.push_back({view.expected->label, kExpectedColor, LegendEntry::Mark::dashes});
  }
  return entries;
}

std::vector<std::vector<LegendEntry>> legend_lines(const std::vector<LegendEntry>& entries,
                                                   int width) {
  std::vector<std::vector<LegendEntry>> lines;
  int used = 0;
  for (const LegendEntry& entry : entries) {
    const int gap = used == 0 ? 0 : gap_after(lines.back().back());
    const int with_this = used + gap + entry_width(entry);
    const bool fits = !lines.empty() && with_this <= width - 2 * kSideMargin;
    if (!fits) lines.emplace_back();
    used = fits ? with_this : entry_width(entry);
    lines.back().push_back(entry);
  }
  return lines;
}

int legend_height(const std::vector<LegendEntry>& entries, int width) {
  return kLineHeight * static_cast<int>(legend_lines(entries, width).size());
}

void draw_legend(Picture& picture, const std::vector<LegendEntry>& entries, int top) {
  for (const std::vector<LegendEntry>& line : legend_lines(entries, picture.width)) {
    int width = -gap_after(line.back());
    for (const LegendEntry& entry : line) width += entry_width(entry) + gap_after(entry);
    int x = (picture.width - width) / 2;
    for (const LegendEntry& entry : line) {
      draw_mark(picture, entry, x, top);
      draw_text(picture, entry.label, x + kMarkWidth + kMarkGap, top + kMarkHeight - 5, Align::left,
                kStyle);
      x += entry_width(entry) + gap_after(entry);
    }
    top += kLineHeight;
  }
}

}  // namespace geoprior
