#include "experiments/paper/scene/join_lines.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

namespace geoprior::paper {
namespace {

/// Ends are numbered: 2 i is the first point of open line i, 2 i + 1 its last one.
class LineJoiner {
 public:
  LineJoiner(std::vector<SvgSubpath> lines, double gap) : lines_(std::move(lines)), gap_(gap) {}

  void join(SvgJoinedLines& result) {
    match_ends();
    std::vector<bool> done(lines_.size(), false);
    // Chains first, from an end that touches nothing; what is left are rings.
    for (const bool ring : {false, true}) {
      for (std::size_t i = 0; i < lines_.size(); ++i) {
        for (const std::size_t end : {2 * i, 2 * i + 1}) {
          if (!done[i] && (ring || partner_[end] == kNone)) walk(end, ring, done, result);
        }
      }
    }
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  [[nodiscard]] const Eigen::Vector2d& end(std::size_t i) const {
    return i % 2 == 0 ? lines_[i / 2].points.front() : lines_[i / 2].points.back();
  }

  void match_ends() {
    partner_.assign(2 * lines_.size(), kNone);
    std::vector<std::size_t> by_x(partner_.size());
    std::iota(by_x.begin(), by_x.end(), std::size_t{0});
    std::sort(by_x.begin(), by_x.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(end(a).x(), a) < std::pair(end(b).x(), b);
    });
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < by_x.size(); ++i) {
      for (std::size_t j = i + 1; j < by_x.size() && end(by_x[j]).x() - end(by_x[i]).x() <= gap_;
           ++j) {
        const auto [a, b] = std::minmax(by_x[i], by_x[j]);
        const bool hardly_a_line = a / 2 == b / 2 && lines_[a / 2].points.size() < 3;
        const double apart = (end(a) - end(b)).norm();
        if (apart <= gap_ && !hardly_a_line) pairs.emplace_back(apart, a, b);
        if (pairs.size() > kMostPairs * by_x.size()) break;  // lines that all begin in one point
      }
    }
    std::sort(pairs.begin(), pairs.end());
    for (const auto& [apart, a, b] : pairs) {
      if (partner_[a] != kNone || partner_[b] != kNone) continue;
      partner_[a] = b;
      partner_[b] = a;
    }
  }

  /// Follows a chain or a ring from one end of a line.
  void walk(std::size_t from, bool ring, std::vector<bool>& done, SvgJoinedLines& result) const {
    SvgSubpath joined;
    joined.closed = ring;
    joined.character = lines_[from / 2].character;
    int pieces = 0;
    for (std::size_t at = from; at != kNone && !done[at / 2];) {
      done[at / 2] = true;
      ++pieces;
      std::vector<Eigen::Vector2d> points = lines_[at / 2].points;
      if (at % 2 == 1) std::reverse(points.begin(), points.end());
      append(joined.points, points, result);
      at = partner_[at % 2 == 0 ? at + 1 : at - 1];
    }
    if (ring) {
      result.pieces += pieces;
      const Eigen::Vector2d last = joined.points.back();
      joined.points.pop_back();
      result.widest_gap = std::max(result.widest_gap, (joined.points.front() - last).norm());
      joined.points.front() = (joined.points.front() + last) / 2;
    }
    (ring ? result.closed : result.open).push_back(std::move(joined));
  }

  static void append(std::vector<Eigen::Vector2d>& line, const std::vector<Eigen::Vector2d>& more,
                     SvgJoinedLines& result) {
    std::size_t first = 0;
    if (!line.empty()) {
      result.widest_gap = std::max(result.widest_gap, (line.back() - more.front()).norm());
      line.back() = (line.back() + more.front()) / 2;
      first = 1;
    }
    line.insert(line.end(), more.begin() + first, more.end());
  }

  static constexpr std::size_t kMostPairs = 50;
  std::vector<SvgSubpath> lines_;
  double gap_;
  std::vector<std::size_t> partner_;
};

}  // namespace

SvgJoinedLines join_svg_lines(const std::vector<SvgSubpath>& lines, double gap) {
  SvgJoinedLines result;
  std::vector<SvgSubpath> open;
  for (const SvgSubpath& line : lines) {
    if (line.points.empty()) continue;
    const bool returns = line.points.size() > 3 && line.points.front() == line.points.back();
    (line.closed || returns ? result.closed : open).push_back(line);
  }
  LineJoiner(std::move(open), gap).join(result);
  return result;
}

}  // namespace geoprior::paper
