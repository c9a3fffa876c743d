#include "solvers/sketch/drawing/ruling_ends.h"

#include <algorithm>
#include <limits>
#include <string>

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

std::array<int, 2> two_borders(const std::vector<double>& from_first,
                               const std::vector<double>& from_second, double reach) {
  const int count = static_cast<int>(from_first.size());
  std::array<int, 2> best{-1, -1};
  double least = std::numeric_limits<double>::infinity();
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      const double sum = from_first[a] + from_second[b];
      if (a == b || from_first[a] >= reach || from_second[b] >= reach || sum >= least) continue;
      least = sum;
      best = {a, b};
    }
  }
  if (best[0] >= 0) return best;
  const auto nearest = [&](const std::vector<double>& distances) {
    const auto least_of = std::min_element(distances.begin(), distances.end());
    if (least_of == distances.end() || *least_of >= reach) return -1;
    return static_cast<int>(least_of - distances.begin());
  };
  return {nearest(from_first), nearest(from_second)};
}

std::array<CurvePoint, 2> ruling_ends(const CurveNet& net, const Stroke& ruling) {
  std::array<std::vector<CurvePoint>, 2> places;
  std::array<std::vector<double>, 2> distances;
  for (const int c : borders_for_ruling(net, ruling)) {
    for (const int k : {0, 1}) {
      const NearestOnNet near =
          nearest_on_curve(net, c, k == 0 ? ruling.points.front() : ruling.points.back());
      places[k].push_back(near.place);
      distances[k].push_back(near.distance);
    }
  }
  const std::array<int, 2> found = two_borders(distances[0], distances[1], reach_of_rulings(net));
  std::array<CurvePoint, 2> ends;
  for (const int k : {0, 1})
    if (found[k] >= 0) ends[k] = places[k][found[k]];
  return ends;
}

}  // namespace geoprior::sketch
