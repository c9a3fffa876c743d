#include "solvers/sketch/drawing/ruling_ends.h"

#include <algorithm>
#include <string>
#include <vector>

namespace geoprior::sketch {
namespace {

/// Ends of rulings may miss by this many snapping distances.
constexpr double kRulingReach = 2;
/// And by this share of the diagonal, however finely ends are snapped.
constexpr double kRulingHand = 0.03;

/// Borders that an end of a ruling may lie on: those of the panel that it names, else all.
std::vector<int> borders_for_ruling(const CurveNet& net, const Stroke& stroke) {
  std::vector<int> all, named;
  for (int c = 0; c < std::ssize(net.curves); ++c) {
    all.push_back(c);
    const std::vector<std::string>& panels = net.curves[c].panels;
    if (std::find(panels.begin(), panels.end(), stroke.name) != panels.end()) named.push_back(c);
  }
  return named.size() < 2 ? all : named;
}

}  // namespace

double reach_of_rulings(const CurveNet& net) {
  return std::max(kRulingReach * net.snap, kRulingHand * net.diagonal);
}

std::array<CurvePoint, 2> ruling_ends(const CurveNet& net, const Stroke& ruling) {
  const std::vector<int> borders = borders_for_ruling(net, ruling);
  const auto near = [&](bool front, int skip) {
    NearestOnNet best{{-1, 0}, reach_of_rulings(net)};
    for (const int c : borders) {
      if (c == skip) continue;
      const NearestOnNet place =
          nearest_on_curve(net, c, front ? ruling.points.front() : ruling.points.back());
      if (place.distance < best.distance) best = place;
    }
    return best;
  };
  const NearestOnNet a = near(true, -1), b = near(false, -1);
  if (a.place.curve < 0 || a.place.curve != b.place.curve) return {a.place, b.place};
  const NearestOnNet other_a = near(true, a.place.curve), other_b = near(false, b.place.curve);
  if (other_a.place.curve < 0 && other_b.place.curve < 0) return {a.place, b.place};
  const bool move_a =
      other_b.place.curve < 0 ||
      (other_a.place.curve >= 0 && other_a.distance + b.distance < a.distance + other_b.distance);
  if (move_a) return {other_a.place, b.place};
  return {a.place, other_b.place};
}

}  // namespace geoprior::sketch
