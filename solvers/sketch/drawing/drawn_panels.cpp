#include "solvers/sketch/drawing/drawn_panels.h"

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace geoprior::sketch {
namespace {

/// Names in the order in which the borders give them.
std::vector<std::string> names_of_panels(const CurveNet& net) {
  std::vector<std::string> names;
  for (const SketchCurve& curve : net.curves) {
    for (const std::string& name : curve.panels) {
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

bool is_ruled(const CurveNet& net, const std::vector<RuledPatch>& ruled, const std::string& name) {
  return std::any_of(ruled.begin(), ruled.end(), [&](const RuledPatch& patch) {
    return bounds(net.curves[patch.first].panels, name) &&
           bounds(net.curves[patch.second].panels, name);
  });
}

bool is_straight(const CurveNet& net, const SketchCurve& curve) {
  if (curve.closed) return false;
  const Eigen::Vector2d& a = net.points[curve.nodes.front()];
  const Eigen::Vector2d chord = (net.points[curve.nodes.back()] - a).normalized();
  return std::all_of(curve.nodes.begin(), curve.nodes.end(), [&](int node) {
    const Eigen::Vector2d d = net.points[node] - a;
    return (d - d.dot(chord) * chord).norm() <= net.snap;
  });
}

/// Takes the border that goes on from a node, in its direction; -1: none.
int take_next(const CurveNet& net, std::vector<int>& left, int node, std::vector<int>& nodes) {
  for (std::size_t k = 0; k < left.size(); ++k) {
    nodes = net.curves[left[k]].nodes;
    if (nodes.back() == node) std::reverse(nodes.begin(), nodes.end());
    if (nodes.front() != node) continue;
    const int taken = left[k];
    left.erase(left.begin() + k);
    return taken;
  }
  return -1;
}

/// A closed loop of nodes, or the curve at an open end.
struct ChainedLoop {
  std::vector<int> loop;
  int open = -1;
};

ChainedLoop chained_loop(const CurveNet& net, std::vector<int> curves) {
  const SketchCurve& start = net.curves[curves.front()];
  if (start.closed && curves.size() == 1) return {start.nodes, -1};
  std::vector<int> loop = start.nodes;
  int last = curves.front();
  curves.erase(curves.begin());
  std::vector<int> nodes;
  while (!net.curves[last].closed && loop.back() != loop.front()) {
    const int next = take_next(net, curves, loop.back(), nodes);
    if (next < 0) break;
    loop.insert(loop.end(), nodes.begin() + 1, nodes.end());
    last = next;
  }
  if (!curves.empty() || loop.back() != loop.front())
    return {{}, curves.empty() ? last : curves.front()};
  loop.pop_back();
  return {std::move(loop), -1};
}

}  // namespace

std::vector<DrawnPanel> find_drawn_panels(const CurveNet& net, const std::vector<RuledPatch>& ruled,
                                          bool skip_open) {
  std::vector<DrawnPanel> panels;
  for (const std::string& name : names_of_panels(net)) {
    if (is_ruled(net, ruled, name)) continue;
    std::vector<int> curves;
    bool straight = true;
    for (int c = 0; c < std::ssize(net.curves); ++c) {
      if (!bounds(net.curves[c].panels, name)) continue;
      curves.push_back(c);
      straight = straight && is_straight(net, net.curves[c]);
    }
    const bool flat = straight || is_named_flat(name);
    ChainedLoop chain = chained_loop(net, curves);
    if (chain.open >= 0 && skip_open) continue;
    if (chain.open >= 0) {
      throw Error("borders of panel '" + name + "' do not form one closed loop",
                  "stroke '" + net.curves[chain.open].id + "'",
                  "one closed border, or borders that meet end to end");
    }
    panels.push_back({name, std::move(chain.loop), flat});
  }
  return panels;
}

}  // namespace geoprior::sketch
