#include "solvers/sketch/drawing/unpaired_borders.h"

#include <algorithm>

namespace geoprior::sketch {
namespace {

bool in_one_flat_panel(const SketchCurve& a, const SketchCurve& b) {
  return std::any_of(a.panels.begin(), a.panels.end(), [&](const std::string& name) {
    return is_named_flat(name) && bounds(b.panels, name);
  });
}

}  // namespace

std::vector<std::string> unpaired_borders(const View& view, const CurveNet& net,
                                          const std::vector<SymmetricPair>& pairs) {
  std::vector<bool> told(net.points.size(), false);  // nodes of borders whose depth is told
  std::vector<bool> paired(net.curves.size(), false);
  const auto tell = [&](int c) {
    paired[c] = true;
    for (const int node : net.curves[c].nodes) told[node] = true;
  };
  for (const SymmetricPair& pair : pairs) {
    for (const auto* places : {&pair.point_at, &pair.image_at})
      for (const CurvePoint& place : *places) tell(place.curve);
  }
  const int count = static_cast<int>(net.curves.size());
  const auto follows = [&](int c) {
    const SketchCurve& curve = net.curves[c];
    if (!curve.closed && told[curve.nodes.front()] && told[curve.nodes.back()]) return true;
    for (int other = 0; other < count; ++other)
      if (paired[other] && in_one_flat_panel(curve, net.curves[other])) return true;
    return false;
  };
  for (bool more = true; more;) {
    more = false;
    for (int c = 0; c < count; ++c) {
      if (paired[c] || !follows(c)) continue;
      tell(c);
      more = true;
    }
  }
  std::vector<std::string> ids;
  for (int s = 0; s < std::ssize(view.strokes); ++s) {
    if (view.strokes[s].kind != StrokeKind::border) continue;
    bool any = false, all_open = true;  // a stroke is several curves when it has corners
    for (int c = 0; c < count; ++c) {
      if (net.curves[c].stroke != s) continue;
      any = true;
      all_open = all_open && !paired[c];
    }
    if (any && all_open) ids.push_back(view.strokes[s].id);
  }
  return ids;
}

}  // namespace geoprior::sketch
