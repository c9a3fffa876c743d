#include "experiments/paper/svg_path.h"

#include <charconv>
#include <cmath>

#include "core/error.h"
#include "experiments/paper/svg_curves.h"
#include "models/paper/pattern.h"

namespace geoprior::paper {
namespace {

/// Characters of path data and where the reader stands.
class PathText {
 public:
  PathText(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  [[noreturn]] void fail(const std::string& problem, const std::string& allowed) const {
    throw Error(problem, where_ + ", character " + std::to_string(at_ + 1), allowed);
  }

  /// The next command letter, 0 at the end, or nothing new when a number follows: then `last`
  /// repeats.
  char command(char last) {
    skip_space();
    if (at_ == text_.size()) return 0;
    const char c = text_[at_];
    if (is_letter(c)) {
      if (std::string_view("MmLlHhVvCcSsQqTtAaZz").find(c) == std::string_view::npos) {
        fail(std::string("unknown command '") + c + "'", "M L H V C S Q T A Z, or lower case");
      }
      ++at_;
      return c;
    }
    if (last == 0) fail("path data does not begin with a command", "M");
    if (last == 'Z' || last == 'z') fail("a number follows Z", "a command");
    // Pairs after a move are lines.
    return last == 'M' ? 'L' : last == 'm' ? 'l' : last;
  }

  double number() {
    skip_space();
    std::size_t from = at_;
    if (from < text_.size() && text_[from] == '+') ++from;
    const std::size_t digits = from < text_.size() && text_[from] == '-' ? from + 1 : from;
    if (digits >= text_.size() || !(is_digit(text_[digits]) || text_[digits] == '.') ||
        (from > at_ && digits > from)) {
      fail("a number is missing", "a number");
    }
    double x = 0;
    const auto [end, error] = std::from_chars(text_.data() + from, text_.data() + text_.size(), x);
    if (error != std::errc{} || !std::isfinite(x)) fail("is no finite number", "a finite number");
    at_ = static_cast<std::size_t>(end - text_.data());
    skip_comma();
    return x;
  }

  /// Flags of an arc may stand without anything between them.
  bool flag() {
    skip_space();
    if (at_ == text_.size() || (text_[at_] != '0' && text_[at_] != '1')) {
      fail("a flag of an arc is missing", "0 or 1");
    }
    const bool value = text_[at_++] == '1';
    skip_comma();
    return value;
  }

 private:
  static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  void skip_space() {
    while (at_ < text_.size() &&
           std::string_view(" \t\r\n\f").find(text_[at_]) != std::string_view::npos)
      ++at_;
  }
  void skip_comma() {
    skip_space();
    if (at_ < text_.size() && text_[at_] == ',') ++at_;
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t at_ = 0;
};

/// Draws the commands: keeps the pen and the control point that S and T reflect.
class PathReader {
 public:
  PathReader(std::string_view d, double tolerance, const std::string& where)
      : text_(d, where), tolerance_(tolerance) {}

  std::vector<Eigen::Vector2d> read() {
    char last = 0;
    while (const char c = text_.command(last)) {
      if (last == 0 && c != 'M' && c != 'm') text_.fail("path data does not begin with M", "M");
      if (last != 0 && (closed_ || c == 'M' || c == 'm')) {
        text_.fail("a second subpath begins", "one closed outline");
      }
      draw(c);
      if (points_.size() > kMostCorners) {
        text_.fail("the outline has too many corners", std::to_string(kMostCorners));
      }
      last = c;
    }
    if (last == 0) text_.fail("path data is empty", "M …");
    return without_repetitions();
  }

 private:
  Eigen::Vector2d point(bool relative) {
    const double x = text_.number();
    const double y = text_.number();
    return (relative ? pen_ : Eigen::Vector2d::Zero()) + Eigen::Vector2d(x, y);
  }

  void line_to(const Eigen::Vector2d& p) {
    points_.push_back(p);
    pen_ = control_ = p;
    curve_ = 0;
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
    pen_ = control_ = arc.to;
    curve_ = 0;
  }

  void draw(char command) {
    const bool relative = command >= 'a';
    switch (relative ? static_cast<char>(command - 'a' + 'A') : command) {
      case 'M':
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
        closed_ = true;
    }
  }

  std::vector<Eigen::Vector2d> without_repetitions() {
    std::vector<Eigen::Vector2d> result;
    for (const Eigen::Vector2d& p : points_) {
      if (result.empty() || p != result.back()) result.push_back(p);
    }
    while (result.size() > 1 && result.front() == result.back()) result.pop_back();
    if (result.size() < 3) text_.fail("the outline has fewer than three points", "an area");
    return result;
  }

  PathText text_;
  double tolerance_;
  std::vector<Eigen::Vector2d> points_;
  Eigen::Vector2d pen_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d control_ = Eigen::Vector2d::Zero();
  int curve_ = 0;
  bool closed_ = false;
};

}  // namespace

std::vector<Eigen::Vector2d> flatten_svg_path(std::string_view d, double tolerance,
                                              const std::string& where) {
  if (!(tolerance > 0)) throw Error("tolerance is not positive", where, "more than 0");
  return PathReader(d, tolerance, where).read();
}

}  // namespace geoprior::paper
