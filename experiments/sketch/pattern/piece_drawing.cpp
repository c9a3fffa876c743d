#include "experiments/sketch/pattern/piece_drawing.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "core/angles.h"
#include "core/geometry/planar.h"
#include "experiments/sketch/pattern/clear_box.h"
#include "experiments/sketch/pattern/seam_allowance.h"
#include "experiments/sketch/pattern/sheet_text.h"
#include "models/sketch/pattern/piece_border.h"

namespace geoprior::sketch {
namespace {

constexpr double kTickApart = 2.5;     // the two ticks of a direction notch (mm)
constexpr double kNumberHeight = 2.5;  // of notches (mm)
constexpr double kVerdictHeight = 3;   // of its line (mm)
constexpr double kLeastLegible = 1.2;  // height of text (mm)
constexpr double kTextRoom = 1.15;     // other sans-serif fonts are wider than Helvetica
constexpr double kLongestGrain = 200;  // mm
constexpr double kLeastGrain = 4;      // mm

/// Draws one piece step by step; later steps keep clear of what earlier ones drew.
class PieceDrawing {
 public:
  PieceDrawing(const Pattern& pattern, int piece, const SheetOptions& options)
      : pattern_(pattern), piece_(pattern.pieces[piece]), index_(piece), options_(options) {}

  SheetPiece draw(const std::vector<Notch>& notches, const std::u32string& verdict) {
    draw_borders();
    for (int i = 0; i < std::ssize(piece_.folds); ++i) draw_fold(i);
    draw_placements();
    draw_holes();
    for (const Notch& notch : notches) {
      if (notch.piece == index_) draw_notch(notch);
    }
    for (const SheetNotch& notch : drawing_.notches) write_number(notch);
    write_name();
    draw_grain();
    write_verdict(verdict);
    return std::move(drawing_);
  }

 private:
  [[nodiscard]] double allowance_of(int edge) const {
    const bool sewn = edge >= 0 && piece_.edges[edge].partner_piece >= 0;
    return sewn ? options_.allowance_mm : options_.hem_mm;
  }

  /// Cutting and sewing lines; decides the piece's own coordinates.
  void draw_borders() {
    const auto edge_of = edge_of_segment(piece_);
    std::vector<AllowanceBorder> borders;
    for (const std::vector<int>& loop : oriented_borders(piece_)) {
      AllowanceBorder border;
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const auto edge = edge_of.find(std::minmax(loop[i], loop[(i + 1) % loop.size()]));
        border.points.emplace_back(piece_.points.row(loop[i]).transpose());
        border.allowance.push_back(allowance_of(edge == edge_of.end() ? -1 : edge->second) / 1000);
      }
      borders.push_back(std::move(border));
    }
    const Eigen::Vector2d g = piece_.grain.normalized();
    drawing_.turn << g.y(), -g.x(), g.x(), g.y();
    const auto loops = cut_lines(borders, options_.miter_limit, piece_label(pattern_, index_));
    Eigen::AlignedBox2d box;
    for (const PlaneLoop& loop : loops) {
      for (const Eigen::Vector2d& p : loop) box.extend(drawing_.own(p));
    }
    drawing_.shift = -box.min();
    drawing_.size = box.sizes();
    for (const PlaneLoop& loop : loops) cut_.push_back(own(loop));
    for (const AllowanceBorder& border : borders) sewn_.push_back(own(border.points));
    add_loops(SheetLayer::cut, cut_);
    add_loops(SheetLayer::sew, sewn_);
    free_ = sewn_;
  }

  void add_loops(SheetLayer layer, const std::vector<PlaneLoop>& loops) {
    for (const PlaneLoop& loop : loops) {
      drawing_.lines.push_back({layer, true, loop, static_cast<int>(&loop - loops.data())});
    }
  }

  [[nodiscard]] PlaneLoop own(const PlaneLoop& points) const {
    PlaneLoop result;
    for (const Eigen::Vector2d& p : points) result.push_back(drawing_.own(p));
    return result;
  }

  void draw_fold(int fold) {
    PlaneLoop points;
    for (const int v : piece_.folds[fold])
      points.push_back(drawing_.own(piece_.points.row(v).transpose()));
    add_line(SheetLayer::fold, points, fold);
  }

  void draw_placements() {
    for (int i = 0; i < std::ssize(piece_.placements); ++i)
      add_line(SheetLayer::place, own(piece_.placements[i]), i);
  }

  /// As polygons, of which no side is farther from the circle than a hundredth of its radius.
  void draw_holes() {
    constexpr int kSides = 24;
    for (int i = 0; i < std::ssize(piece_.holes); ++i) {
      const PieceHole& hole = piece_.holes[i];
      PlaneLoop circle;
      for (int k = 0; k < kSides; ++k) {
        const double angle = kFullTurn * k / kSides;
        circle.push_back(drawing_.own(
            hole.centre + hole.radius * Eigen::Vector2d(std::cos(angle), std::sin(angle))));
      }
      add_line(SheetLayer::drill, circle, i);
      drawing_.lines.back().closed = true;
    }
  }

  void add_line(SheetLayer layer, const PlaneLoop& points, int number = 0) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      obstacles_.push_back({points[i], points[i + 1]});
    }
    drawing_.lines.push_back({layer, false, points, number});
  }

  /// Where a ray leaves the cut piece; where nothing is cut within reach (a dart that its
  /// allowances close), its start.
  [[nodiscard]] Eigen::Vector2d cut_point(const Eigen::Vector2d& from, const Eigen::Vector2d& d,
                                          double allowance) const {
    const double before = -0.5, reach = options_.miter_limit * allowance + 0.5;
    double nearest = std::numeric_limits<double>::infinity();
    for (const PlaneLoop& loop : cut_) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Eigen::Vector2d a = loop[i] - from, along = loop[(i + 1) % loop.size()] - loop[i];
        const double slope = cross(d, along);
        if (slope == 0) continue;
        const double t = cross(a, along) / slope, s = cross(a, d) / slope;
        if (s >= -1e-9 && s <= 1 + 1e-9 && t >= before && t <= reach) {
          nearest = std::min(nearest, std::abs(t - allowance) < 1e-6 ? allowance : t);
        }
      }
    }
    return nearest <= reach ? Eigen::Vector2d(from + nearest * d) : from;
  }

  void draw_notch(const Notch& notch) {
    const Eigen::Vector2d outward = drawing_.turn * notch.outward;
    const Eigen::Vector2d along(-outward.y(), outward.x());
    const double allowance = allowance_of(notch.edge);
    SheetNotch drawn{notch.label, notch.direction, drawing_.own(notch.point), {}, notch.arc,
                     notch.piece, notch.edge};
    drawn.cut = cut_point(drawn.sewn, outward, allowance);
    const double deep = allowance > 0 ? std::min(options_.notch_length_mm, 0.6 * allowance)
                                      : options_.notch_length_mm;
    const std::vector<double> beside =
        notch.direction ? std::vector{-kTickApart / 2, kTickApart / 2} : std::vector{0.0};
    for (const double shift : beside) {
      const Eigen::Vector2d outer = cut_point(drawn.sewn + shift * along, outward, allowance);
      add_line(SheetLayer::notch, {outer, outer - deep * outward}, notch.label);
    }
    drawing_.notches.push_back(drawn);
    inward_.push_back(-outward);
  }

  bool write_if_clear(const Eigen::Vector2d& middle, double height, const std::u32string& text) {
    const Eigen::Vector2d half(kTextRoom * helvetica_width(text) * height / 2 + 0.4,
                               height / 2 + 0.2);
    const Eigen::AlignedBox2d box(Eigen::Vector2d(middle - half), Eigen::Vector2d(middle + half));
    if (!is_clear(box, free_, obstacles_)) return false;
    add_text(box, middle, height, text);
    return true;
  }

  void add_text(const Eigen::AlignedBox2d& box, const Eigen::Vector2d& middle, double height,
                const std::u32string& text) {
    free_.push_back(
        {box.min(), {box.max().x(), box.min().y()}, box.max(), {box.min().x(), box.max().y()}});
    drawing_.texts.push_back({middle, height, text});
  }

  /// Inside of the sewing line, as near to the notch as there is room.
  void write_number(const SheetNotch& notch) {
    const std::string digits = std::to_string(notch.label);
    const std::u32string text(digits.begin(), digits.end());
    const Eigen::Vector2d inward = inward_[numbered_++];
    const Eigen::Vector2d along(inward.y(), -inward.x());
    for (const double height : {kNumberHeight, kLeastLegible}) {
      for (int step = 2; step <= 10; ++step) {
        for (const double aside : {0.0, 1.0, -1.0}) {
          const Eigen::Vector2d middle =
              notch.sewn + height * (0.5 * step * inward + 1.2 * aside * along);
          if (write_if_clear(middle, height, text)) return;
        }
      }
    }
  }

  /// Name and "number of all" below it, in the widest room, in at most text_mm.
  void write_name() {
    const std::string count =
        std::to_string(index_ + 1) + " of " + std::to_string(pattern_.pieces.size());
    const std::u32string below(count.begin(), count.end());
    drawing_.name = piece_.name;
    drawing_.label = label_text(piece_.name, 40);
    for (const std::size_t most : {std::size_t{40}, std::size_t{20}, std::size_t{8}}) {
      const std::u32string name = label_text(piece_.name, most);
      // In units of the name's height: both lines, and a margin around them.
      const double width =
          kTextRoom * std::max(helvetica_width(name), 0.6 * helvetica_width(below)) + 0.6;
      const double height = 1 + 0.3 + 0.6 + 0.6;
      const auto box = largest_clear_box(free_, obstacles_, width / height);
      if (box.isEmpty()) return;
      const double h = std::min(options_.text_mm, box.sizes().y() / height);
      if (h < kLeastLegible / 0.6) {
        if (most > 8) continue;
        if (h < kLeastLegible) return;
      }
      const Eigen::Vector2d m = box.center(), half = h / 2 * Eigen::Vector2d(width, height);
      add_text({Eigen::Vector2d(m - half), Eigen::Vector2d(m + half)},
               m + Eigen::Vector2d(0, 0.45 * h), h, name);
      drawing_.texts.push_back({m - Eigen::Vector2d(0, 0.65 * h), 0.6 * h, below});
      return;
    }
  }

  /// In the widest room that is left, small: it is for whoever sews, not for whoever cuts.
  void write_verdict(const std::u32string& verdict) {
    drawing_.verdict = verdict;
    if (verdict.empty()) return;
    const double width = kTextRoom * helvetica_width(verdict) + 0.6, height = 1.6;
    const auto box = largest_clear_box(free_, obstacles_, width / height);
    if (box.isEmpty()) return;
    const double h = std::min(kVerdictHeight, box.sizes().y() / height);
    if (h < kLeastLegible) return;
    const Eigen::Vector2d m = box.center(), half = h / 2 * Eigen::Vector2d(width, height);
    add_text({Eigen::Vector2d(m - half), Eigen::Vector2d(m + half)}, m, h, verdict);
  }

  /// An upright arrow in the tallest room that is left.
  void draw_grain() {
    for (const double aspect : {0.2, 0.4, 0.8}) {
      const auto box = largest_clear_box(free_, obstacles_, aspect);
      if (box.isEmpty()) return;
      const double length = std::min(0.86 * box.sizes().y(), kLongestGrain);
      if (length < kLeastGrain && aspect < 0.8) continue;
      const Eigen::Vector2d up(0, length / 2), tip = box.center() + up;
      const double head = std::min(3.5, 0.2 * length);
      add_line(SheetLayer::grain, {box.center() - up, tip});
      add_line(SheetLayer::grain, {tip + head * Eigen::Vector2d(-0.35, -1), tip,
                                   tip + head * Eigen::Vector2d(0.35, -1)});
      return;
    }
  }

  const Pattern& pattern_;
  const PatternPiece& piece_;
  int index_;
  const SheetOptions& options_;
  SheetPiece drawing_;
  std::vector<PlaneLoop> cut_, sewn_;
  std::vector<PlaneLoop> free_;  ///< sewing lines and, as holes, boxes around texts
  std::vector<PlaneSegment> obstacles_;
  std::vector<Eigen::Vector2d> inward_;  ///< of each notch that is drawn
  std::size_t numbered_ = 0;
};

}  // namespace

SheetPiece draw_piece(const Pattern& pattern, int piece, const std::vector<Notch>& notches,
                      const SheetOptions& options, const std::u32string& verdict) {
  return PieceDrawing(pattern, piece, options).draw(notches, verdict);
}

}  // namespace geoprior::sketch
