#include "experiments/paper/scene/svg_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/error.h"
#include "core/geometry/planar.h"
#include "experiments/paper/scene/svg_choice.h"

namespace geoprior::paper {
namespace {

// The keys of the scene that errors name.
const std::string kFileKey = "scene.pattern.file: ";
const std::string kPathKey = "scene.pattern.path: ";
const std::string kUnitKey = "scene.pattern.unit";

/// Height of a box about a line's points, over its length, under which they lie on a line.
constexpr double kFlattest = 1e-6;

/// One unit of the viewBox where nothing says more (m).
constexpr double kUsualUnit = 1e-3;

using Loop = std::vector<Eigen::Vector2d>;

SvgDocument read_drawing(const std::filesystem::path& file, const SvgPatternOptions& options) {
  SvgReadOptions read;
  read.tolerance = options.tolerance;
  if (options.unit == SvgScale::page) {
    if (options.unit_m) {
      throw Error("is \"page\" beside a unit_m", kUnitKey, "unit_m, or the page's size, not both");
    }
  } else {
    read.unit_m = options.unit_m.value_or(kUsualUnit);
    read.page_first = options.unit == SvgScale::guess && !options.unit_m;
  }
  try {
    return read_svg_document(file, read);
  } catch (const Error& error) {
    throw Error(kFileKey + error.what());
  }
}

std::string millimetres(double metres) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.6g", 1e3 * metres);
  return text.data();
}

/// How large a unit of the viewBox is by the page: "0.264583 mm", or "2 mm x 1 mm".
std::string page_unit_text(const SvgDocument& drawing) {
  const Eigen::Vector2d& unit = drawing.page_unit;
  const std::string across = millimetres(unit.x()) + " mm";
  const bool square = std::abs(unit.x() - unit.y()) <= 1e-6 * unit.x();
  return square ? across : across + " x " + millimetres(unit.y()) + " mm";
}

/// Which scale was taken, where the options leave it open or the page contradicts.
void note_scale(const SvgDocument& drawing, const SvgPatternOptions& options,
                std::vector<std::string>& notes) {
  const std::string page = "a unit of its viewBox is " + page_unit_text(drawing);
  const Eigen::Vector2d& unit = drawing.page_unit;
  const bool stretched = std::abs(unit.x() - unit.y()) > 1e-6 * unit.x();
  std::string note;
  if (!drawing.unit_m) {
    note = page + " by the size of its page" +
           (drawing.true_size ? "" : ", which is in px, of which 96 are taken for an inch");
    if (options.unit == SvgScale::guess) note += "; unit_m says otherwise";
  } else if (!options.unit_m && !drawing.true_size) {
    note = "its page has no size in mm, cm, in, pt or pc: a unit of its viewBox is taken for " +
           millimetres(*drawing.unit_m) + " mm; unit_m says otherwise";
  }
  if (drawing.unit_m && stretched) {
    note += (note.empty() ? "" : "; ") + std::string("its page stretches what it draws, ") + page +
            ", and unit_m does not: unit = \"page\" does";
  }
  if (!note.empty()) notes.push_back(drawing.name + ": " + note);
}

/// Whether the points lie on a line, by the axes of their moments of inertia.
bool is_flat(const Loop& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& p : points) mean += p / static_cast<double>(points.size());
  double xx = 0, xy = 0, yy = 0;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d d = p - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double large = (xx + yy) / 2 + std::hypot((xx - yy) / 2, xy);
  return xx * yy - xy * xy <= kFlattest * kFlattest * large * large;
}

Loop closed_loop(const SvgSubpath& line, const std::string& where) {
  Loop loop = line.points;
  loop.erase(std::unique(loop.begin(), loop.end()), loop.end());
  while (loop.size() > 1 && loop.front() == loop.back()) loop.pop_back();
  const std::string here =
      where + (line.character > 0 ? ", character " + std::to_string(line.character) : "");
  if (loop.size() < 3) throw Error("the outline has fewer than three points", here, "an area");
  if (is_flat(loop)) {
    throw Error("the outline is flattened to a line", here,
                "an outline with area, and transforms that leave it one");
  }
  return loop;
}

double area_of(const Loop& loop) { return signed_area({loop}); }

/// The loop of the largest area is the border, the others are holes in their order.
Pattern loops_of(const SvgChoice& choice, const std::string& where) {
  if (choice.lines.empty())
    throw Error("has no extent or no data, and draws nothing", where, "an outline with area");
  std::size_t points = 0;
  for (const SvgSubpath& line : choice.lines) points += line.points.size();
  // A closed line may name its first point again.
  if (points > kMostCorners + choice.lines.size())
    throw Error("the outline has too many corners", where, std::to_string(kMostCorners));
  Pattern pattern;
  for (const SvgSubpath& line : choice.lines) pattern.holes.push_back(closed_loop(line, where));
  const auto largest = std::max_element(
      pattern.holes.begin(), pattern.holes.end(),
      [&](const Loop& a, const Loop& b) { return std::abs(area_of(a)) < std::abs(area_of(b)); });
  pattern.border = std::move(*largest);
  pattern.holes.erase(largest);
  return pattern;
}

/// How often a loop runs round a point, counter-clockwise.
int turns_round(const Loop& loop, const Eigen::Vector2d& p) {
  int turns = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector2d& a = loop[i];
    const Eigen::Vector2d& b = loop[i + 1 == loop.size() ? 0 : i + 1];
    if (a.y() <= p.y() && b.y() > p.y() && orientation(a, b, p) > 0) ++turns;
    if (a.y() > p.y() && b.y() <= p.y() && orientation(a, b, p) < 0) --turns;
  }
  return turns;
}

/// Takes out the loops that have paper on both sides by fill-rule nonzero.
void leave_out_filled(Pattern& pattern, const std::string& where, const std::string& place,
                      std::vector<std::string>& notes) {
  const std::vector<Loop> loops = pattern.holes;
  std::vector<Loop> holes;
  for (std::size_t k = 0; k < loops.size(); ++k) {
    int outside = turns_round(pattern.border, loops[k].front());
    for (std::size_t l = 0; l < loops.size(); ++l)
      outside += l == k ? 0 : turns_round(loops[l], loops[k].front());
    const int inside = outside + (area_of(loops[k]) > 0 ? 1 : -1);
    if ((outside != 0) != (inside != 0)) {
      holes.push_back(loops[k]);
      continue;
    }
    require_simple_loops({pattern.border, {loops[k]}}, where);
    notes.push_back(place + ": line " + std::to_string(k) +
                    " beside the border runs the same way round as what is around it: by fill-rule "
                    "nonzero it is no hole, and is left out");
  }
  pattern.holes = std::move(holes);
}

/// Without corners that clipping made twice.
Loop without_doubles(const Loop& loop, double distance) {
  Loop clean;
  for (const Eigen::Vector2d& p : loop) {
    if (clean.empty() || (p - clean.back()).norm() > distance) clean.push_back(p);
  }
  while (clean.size() > 1 && (clean.front() - clean.back()).norm() <= distance) clean.pop_back();
  return clean;
}

/// Cuts off what a clip path hides.
void clip_pattern(Pattern& pattern, const SvgClip& clip, const std::string& where) {
  const double noise = 1e-9 * width(pattern);
  const auto clipped = [&](const Loop& loop) {
    return without_doubles(clipped_loop(loop, clip.region), noise);
  };
  Loop border = clipped(pattern.border);
  if (border.size() < 3) throw Error(clip.name + " hides all of it", where, "an outline");
  std::vector<Loop> holes;
  for (const Loop& hole : pattern.holes) {
    if (!hides_part_of(clip, {{hole, true, 0}})) {
      holes.push_back(hole);
    } else if (clipped(hole).size() >= 3) {
      throw Error(clip.name + " runs across a hole", where, "an outline as it is seen");
    }
  }
  pattern = {std::move(border), std::move(holes)};
}

void apply_clips(Pattern& pattern, const SvgDocument& drawing, const SvgChoice& choice,
                 std::string& where, std::vector<std::string>& notes) {
  for (const int index : choice.clips) {
    const SvgClip& clip = drawing.clips[index];
    if (!hides_part_of(clip, {{pattern.border, true, 0}})) continue;
    const std::string note = choice.where + ": " + clip.name;
    if (clip.viewport) {
      notes.push_back(note + " hides a part of it in browsers, and is not applied");
    } else if (clip.region.empty()) {
      notes.push_back(note +
                      " is not applied, as it is more than one convex shape: what it hides is part "
                      "of the sheet");
    } else {
      clip_pattern(pattern, clip, where);
      where += " (cut off by " + clip.name + ")";
      notes.push_back(note + " cuts off a part of it");
    }
  }
}

void move(Pattern& pattern, const Eigen::Vector2d& shift) {
  for (Eigen::Vector2d& p : pattern.border) p += shift;
  for (Loop& hole : pattern.holes) {
    for (Eigen::Vector2d& p : hole) p += shift;
  }
}

}  // namespace

Pattern read_svg_pattern(const std::filesystem::path& file, const SvgPatternOptions& options,
                         std::vector<std::string>& notes) {
  const SvgDocument drawing = read_drawing(file, options);
  notes.insert(notes.end(), drawing.notes.begin(), drawing.notes.end());
  note_scale(drawing, options, notes);
  const SvgChoice choice = choose_lines(drawing, options.path, options.tolerance, kPathKey, notes);
  std::string where = kFileKey + choice.where;
  Pattern pattern = loops_of(choice, where);
  if (choice.nonzero) leave_out_filled(pattern, where, choice.where, notes);
  apply_clips(pattern, drawing, choice, where, notes);
  require_simple_loops(pattern, where);
  move(pattern, options.centred ? Eigen::Vector2d(-bounding_box(pattern).center())
                                : Eigen::Vector2d(-drawing.user_origin));
  return oriented(std::move(pattern));
}

}  // namespace geoprior::paper
