#include "testbed/formats/svg/path.h"

#include <utility>

#include "core/error.h"
#include "testbed/formats/svg/curves.h"
#include "testbed/formats/svg/text.h"

namespace geoprior {
namespace {

/// Draws the commands: keeps the pen and the control point that S and T reflect.
class SvgPathReader {
 public:
  SvgPathReader(std::string_view d, double tolerance, const std::string& where)
      : text_(d, where), tolerance_(tolerance) {}

  std::vector<SvgSubpath> read() {
    char last = 0;
    while (const char c = next_command(last)) {
      if (last == 0 && c != 'M' && c != 'm') text_.fail("path data does not begin with M", "M");
      draw(c);
      if (finished_points_ + points_.size() > kMostSvgPathPoints) {
        text_.fail("the path has too many points", std::to_string(kMostSvgPathPoints));
      }
      last = c;
    }
    if (last == 0) text_.fail("path data is empty", "M …");
    finish(false);
    return std::move(subpaths_);
  }

 private:
  /// The next command letter, 0 at the end, or nothing new when a number follows: then `last`
  /// repeats.
  char next_command(char last) {
    const char c = text_.peek();
    if (c == 0) return 0;
    if ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) {
      if (std::string_view("MmLlHhVvCcSsQqTtAaZz").find(c) == std::string_view::npos) {
        text_.fail(std::string("unknown command '") + c + "'",
                   "M L H V C S Q T A Z, or lower case");
      }
      return text_.take();
    }
    if (last == 0) text_.fail("path data does not begin with a command", "M");
    if (last == 'Z' || last == 'z') text_.fail("a number follows Z", "a command");
    // Pairs after a move are lines.
    return last == 'M' ? 'L' : last == 'm' ? 'l' : last;
  }

  Eigen::Vector2d point(bool relative) {
    const double x = text_.number();
    const double y = text_.number();
    return (relative ? pen_ : Eigen::Vector2d::Zero()) + Eigen::Vector2d(x, y);
  }

  void set_pen(const Eigen::Vector2d& p) {
    pen_ = control_ = p;
    curve_ = 0;
  }

  void line_to(const Eigen::Vector2d& p) {
    points_.push_back(p);
    set_pen(p);
  }

  /// `kind`: 3 for C and S, 2 for Q and T; the control point is only reflected by its own kind.
  void curve_to(int kind, const Eigen::Vector2d& p1, const Eigen::Vector2d& p2,
                const Eigen::Vector2d& control, const Eigen::Vector2d& p3) {
    flatten_cubic(pen_, p1, p2, p3, tolerance_, points_);
    pen_ = p3;
    control_ = control;
    curve_ = kind;
  }

  void quadratic_to(const Eigen::Vector2d& q, const Eigen::Vector2d& p) {
    curve_to(2, pen_ + 2.0 / 3 * (q - pen_), p + 2.0 / 3 * (q - p), q, p);
  }

  [[nodiscard]] Eigen::Vector2d reflected(int kind) const {
    return curve_ == kind ? Eigen::Vector2d(2 * pen_ - control_) : pen_;
  }

  void arc_to(bool relative) {
    SvgArc arc;
    arc.from = pen_;
    const double rx = text_.number();
    const double ry = text_.number();
    arc.radii = {rx, ry};
    arc.turn_deg = text_.number();
    arc.large = text_.flag();
    arc.sweep = text_.flag();
    arc.to = point(relative);
    flatten_arc(arc, tolerance_, points_);
    set_pen(arc.to);
  }

  void move_to(const Eigen::Vector2d& p) {
    finish(false);
    character_ = text_.character();
    start_ = p;
    set_pen(p);
  }

  void draw(char command) {
    const bool relative = command >= 'a';
    const char upper = relative ? static_cast<char>(command - 'a' + 'A') : command;
    if (upper == 'M') return move_to(point(relative));
    if (upper == 'Z' && character_ == 0) return;  // closes what is closed
    if (!drawn_) {
      // Behind Z a line may go on from the point where the closed one began.
      points_.push_back(start_);
      if (character_ == 0) character_ = text_.character();
      drawn_ = true;
    }
    draw_line(upper, relative);
  }

  void draw_line(char command, bool relative) {
    switch (command) {
      case 'L':
        return line_to(point(relative));
      case 'H': {
        const double x = text_.number();
        return line_to({x + (relative ? pen_.x() : 0), pen_.y()});
      }
      case 'V': {
        const double y = text_.number();
        return line_to({pen_.x(), y + (relative ? pen_.y() : 0)});
      }
      case 'C': {
        const Eigen::Vector2d p1 = point(relative), p2 = point(relative), p3 = point(relative);
        return curve_to(3, p1, p2, p2, p3);
      }
      case 'S': {
        const Eigen::Vector2d p2 = point(relative), p3 = point(relative);
        return curve_to(3, reflected(3), p2, p2, p3);
      }
      case 'Q': {
        const Eigen::Vector2d q = point(relative), p = point(relative);
        return quadratic_to(q, p);
      }
      case 'T':
        return quadratic_to(reflected(2), point(relative));
      case 'A':
        return arc_to(relative);
      default:
        finish(true);
        set_pen(start_);
    }
  }

  void finish(bool closed) {
    if (drawn_) {
      SvgSubpath line{{}, closed, character_};
      for (const Eigen::Vector2d& p : points_) {
        if (line.points.empty() || p != line.points.back()) line.points.push_back(p);
      }
      while (closed && line.points.size() > 1 && line.points.front() == line.points.back())
        line.points.pop_back();
      finished_points_ += line.points.size();
      subpaths_.push_back(std::move(line));
    }
    points_.clear();
    drawn_ = false;
    character_ = 0;
  }

  SvgText text_;
  double tolerance_;
  std::vector<SvgSubpath> subpaths_;
  std::size_t finished_points_ = 0;
  std::vector<Eigen::Vector2d> points_;  ///< of the subpath that is being drawn
  bool drawn_ = false;                   ///< it has more than its move
  std::size_t character_ = 0;            ///< behind its first command, 0: it has none yet
  Eigen::Vector2d start_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d pen_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d control_ = Eigen::Vector2d::Zero();
  int curve_ = 0;
};

}  // namespace

std::vector<SvgSubpath> flatten_svg_subpaths(std::string_view d, double tolerance,
                                             const std::string& where) {
  if (!(tolerance > 0)) throw Error("tolerance is not positive", where, "more than 0");
  return SvgPathReader(d, tolerance, where).read();
}

}  // namespace geoprior
