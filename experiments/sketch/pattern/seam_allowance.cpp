#include "experiments/sketch/pattern/seam_allowance.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/geometry/planar.h"

namespace geoprior::sketch {
namespace {

/// Waste between allowances that is too small to cut (m²).
constexpr double kSmallestWaste = 1e-6;

struct BorderSegment {
  Eigen::Vector2d a, b;
  std::size_t border, index, count;  ///< of the segments of its border

  [[nodiscard]] double left() const { return std::min(a.x(), b.x()); }
  [[nodiscard]] double right() const { return std::max(a.x(), b.x()); }
};

bool border_neighbours(const BorderSegment& s, const BorderSegment& t) {
  return s.border == t.border &&
         ((s.index + 1) % s.count == t.index || (t.index + 1) % t.count == s.index);
}

/// Neighbours share an end; they cross when one folds back onto the other.
bool border_folds_back(const BorderSegment& s, const BorderSegment& t) {
  const bool s_first = s.b == t.a;
  const BorderSegment& first = s_first ? s : t;
  const BorderSegment& second = s_first ? t : s;
  return orientation(first.a, first.b, second.b) == 0 &&
         (first.b - first.a).dot(second.b - second.a) < 0;
}

/// Sweeps the segments by their left ends, so that only those that overlap in x are compared.
void require_simple_borders(const std::vector<AllowanceBorder>& borders, const std::string& where) {
  std::vector<BorderSegment> segments;
  for (std::size_t k = 0; k < borders.size(); ++k) {
    const PlaneLoop& p = borders[k].points;
    for (std::size_t i = 0; i < p.size(); ++i) {
      segments.push_back({p[i], p[(i + 1) % p.size()], k, i, p.size()});
    }
  }
  std::stable_sort(
      segments.begin(), segments.end(),
      [](const BorderSegment& s, const BorderSegment& t) { return s.left() < t.left(); });
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const BorderSegment& s = segments[i];
    for (std::size_t j = i + 1; j < segments.size() && segments[j].left() <= s.right(); ++j) {
      const BorderSegment& t = segments[j];
      if (border_neighbours(s, t) ? border_folds_back(s, t) : segments_meet(s.a, s.b, t.a, t.b)) {
        throw Error("the border meets itself at segment " + std::to_string(s.index) + " of loop " +
                        std::to_string(s.border) + " and segment " + std::to_string(t.index) +
                        " of loop " + std::to_string(t.border),
                    where, "simple borders: a piece that overlaps itself cannot be cut out");
      }
    }
  }
}

void require_offsettable(const std::vector<AllowanceBorder>& borders, double miter_limit,
                         const std::string& where) {
  if (!(miter_limit >= 1)) throw Error("miter limit is below 1", where, "1 or more");
  for (std::size_t k = 0; k < borders.size(); ++k) {
    const AllowanceBorder& border = borders[k];
    const std::string loop = "loop " + std::to_string(k);
    const std::size_t n = border.points.size();
    if (n < 3) throw Error(loop + " has fewer than three points", where, "an area");
    if (border.allowance.size() != n) {
      throw Error(loop + " has allowances for " + std::to_string(border.allowance.size()) +
                      " segments of " + std::to_string(n),
                  where, "one for each segment");
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (!border.points[i].allFinite()) {
        throw Error("point " + std::to_string(i) + " of " + loop + " is not finite", where);
      }
      if (border.points[i] == border.points[(i + 1) % n]) {
        throw Error("point " + std::to_string(i) + " of " + loop + " repeats", where,
                    "no two equal points in a row");
      }
      if (!(border.allowance[i] >= 0 && std::isfinite(border.allowance[i]))) {
        throw Error("allowance of segment " + std::to_string(i) + " of " + loop, where,
                    "0 or more");
      }
    }
    if ((loop_area(border.points) > 0) != (k == 0)) {
      throw Error(loop + " runs the wrong way round", where,
                  "outer border counter-clockwise, holes clockwise");
    }
  }
  require_simple_borders(borders, where);
}

/// A corner of the border: what lies before and behind it.
struct AllowanceCorner {
  Eigen::Vector2d before, at, behind;
  double width_before, width_behind;  ///< allowances
};

/// Appends the outer line around a convex corner, from the strip before to the strip behind.
///
/// With the turn θ the outer lines meet at p + a1 n1 + t1 d1, t1 = (a2 - a1 cos θ) / sin θ, and
/// likewise from behind. A negative t lies beside a strip: then there is nothing to prolong.
void append_convex(const AllowanceCorner& c, double miter_limit, PlaneLoop& chain) {
  const Eigen::Vector2d d1 = (c.at - c.before).normalized();
  const Eigen::Vector2d d2 = (c.behind - c.at).normalized();
  const Eigen::Vector2d n1(d1.y(), -d1.x()), n2(d2.y(), -d2.x());
  const double a1 = c.width_before, a2 = c.width_behind;
  const double sine = cross(d1, d2), cosine = d1.dot(d2);
  const Eigen::Vector2d end1 = c.at + a1 * n1, end2 = c.at + a2 * n2;
  const double along1 = a2 - a1 * cosine, along2 = a1 - a2 * cosine;  // times sin θ
  if (sine <= 0 || along1 < 0 || along2 < 0) {
    chain.push_back(end1);
    chain.push_back(end2);
    return;
  }
  const Eigen::Vector2d tip = a1 * n1 + along1 / sine * d1;
  const double reach = tip.norm(), most = miter_limit * std::max(a1, a2);
  if (reach <= most) {
    chain.push_back(c.at + tip);
    return;
  }
  // Straight across at the distance `most` on the way to the tip.
  const Eigen::Vector2d u = tip / reach;
  chain.push_back(end1 + (most - a1 * n1.dot(u)) / d1.dot(u) * d1);
  chain.push_back(end2 + (most - a2 * n2.dot(u)) / d2.dot(u) * d2);
}

/// The border's chain plus those of its strips and caps: around a point it winds as often as
/// the piece, strips and caps cover it.
PlaneLoop raw_offset(const AllowanceBorder& border, double miter_limit) {
  PlaneLoop chain;
  const std::size_t n = border.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t h = (i + n - 1) % n;
    const AllowanceCorner c{border.points[h], border.points[i], border.points[(i + 1) % n],
                            border.allowance[h], border.allowance[i]};
    const int turn = orientation(c.before, c.at, c.behind);
    if (turn > 0 || (turn == 0 && c.width_before == c.width_behind)) {
      append_convex(c, miter_limit, chain);
      continue;
    }
    const auto moved = [](const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                          const Eigen::Vector2d& at, double width) {
      const Eigen::Vector2d d = (to - from).normalized();
      return Eigen::Vector2d(at + width * Eigen::Vector2d(d.y(), -d.x()));
    };
    chain.push_back(moved(c.before, c.at, c.at, c.width_before));
    chain.push_back(c.at);
    chain.push_back(moved(c.at, c.behind, c.at, c.width_behind));
  }
  return chain;
}

}  // namespace

std::vector<PlaneLoop> cut_lines(const std::vector<AllowanceBorder>& borders, double miter_limit,
                                 const std::string& where) {
  if (borders.empty()) throw Error("no border", where, "an outer border");
  require_offsettable(borders, miter_limit, where);
  bool any = false;
  std::vector<PlaneLoop> chains;
  for (const AllowanceBorder& border : borders) {
    for (const double width : border.allowance) any = any || width > 0;
    chains.push_back(border.points);
  }
  if (!any) return chains;
  for (std::size_t k = 0; k < borders.size(); ++k) chains[k] = raw_offset(borders[k], miter_limit);
  std::vector<PlaneLoop> loops = positive_winding_border(chains);
  std::erase_if(loops, [](const PlaneLoop& loop) {
    const double area = loop_area(loop);
    return area < 0 && -area < kSmallestWaste;
  });
  return loops;
}

}  // namespace geoprior::sketch
